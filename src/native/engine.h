// The vectorised CPU backend of the fused pass: a cloth, its kernel, its threads.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>

#include "native/bands.h"
#include "native/thread_choice.h"
#include "plan/plan.h"

namespace weft::native {

struct EngineOptions {
  std::uint32_t threads = 0;  ///< 0: WEFT_THREADS, else by trial
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
  /// @param constants  of the plan's `integrate`
  /// @throws Error(Exit::usage) for a kernel that this machine does not have, or a WEFT_THREADS that is no
  /// number
  Engine(const Model& model, std::span<const Constant> constants, const EngineOptions& options = {});

  void load(const State& state) { cloth_.load(state); }
  void store(State& state) { cloth_.store(state); }
  /// One sweep a row of the schedule.
  void sweep(std::span<const Kick> kicks);
  void write_surface(const SurfaceTarget& target);
  const Kernels& kernels() const { return kernels_; }
  std::uint32_t threads() const { return choice_.best(); }
  std::uint64_t bytes() const { return cloth_.bytes(); }

 private:
  Bands& bands(std::uint32_t count);
  Cloth cloth_;
  const Kernels& kernels_;
  ThreadChoice choice_;
  std::unique_ptr<Crew> crew_;
  std::map<std::uint32_t, std::unique_ptr<Bands>> bands_;  ///< by count, made when first wanted
};

}  // namespace weft::native
