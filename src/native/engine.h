// The vectorised CPU backend of the fused pass: a cloth, its kernel, its threads.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>

#include "native/bands.h"
#include "native/thread_choice.h"
#include "native/xpbd.h"
#include "plan/plan.h"

namespace weft::native {

struct EngineOptions {
  std::uint32_t threads = 0;  ///< exactly that many; 0: by trial, at most WEFT_THREADS and one a core
  std::string vector;         ///< a kernel's name; empty: WEFT_VECTOR, else the widest
};

/// Why the vector kernels do not run this plan; empty when they do.
std::string unsupported(const Plan& plan);

/// Where what is drawn goes: vec4 a particle. Velocity may be null.
struct SurfaceTarget {
  float *position, *normal, *velocity = nullptr;
};

class Engine {
 public:
  /// @param plan  one that is not unsupported()
  /// @throws Error(Exit::usage) for a kernel that this machine does not have, or a WEFT_THREADS that is no
  /// number
  Engine(const Model& model, const Plan& plan, const EngineOptions& options = {});

  /// Another model of the same grid, with its plan. The state has to be loaded again.
  void adopt(const Model& model, const Plan& plan);
  /// Takes positions and velocities.
  void load(const HostBuffers<float>& buffers) { cloth_.load(buffers); }
  /// Sweeps rows [first, first + count) of a frame's schedule.
  void sweep(const KickTable& table, std::uint32_t first, std::uint32_t count);
  void write_surface(const SurfaceTarget& target);
  const Kernels& kernels() const { return kernels_; }
  std::uint32_t threads() const { return choice_.best(); }
  std::uint64_t bytes() const;

 private:
  Bands& bands(std::uint32_t count);
  Crew& crew(std::uint32_t count);
  /// What the plan's solver needs beside the cloth.
  void furnish(const Model& model, const Plan& plan);

  Cloth cloth_;
  const Kernels& kernels_;
  Floats half_velocity_;        ///< velocity Verlet's
  std::unique_ptr<Xpbd> xpbd_;  ///< the sweeps, where XPBD is the solver
  ThreadChoice choice_;
  std::unique_ptr<Crew> crew_;
  std::map<std::uint32_t, std::unique_ptr<Bands>> bands_;  ///< by count, made when first wanted
};

}  // namespace weft::native
