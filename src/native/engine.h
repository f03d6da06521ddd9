// The vectorised CPU backend: a cloth, its kernels, its threads.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "native/bands.h"
#include "native/crew_rows.h"
#include "native/effects.h"
#include "native/engine_options.h"
#include "native/link_watch.h"
#include "native/self_collision.h"
#include "native/spread_frames.h"
#include "native/surface_target.h"
#include "native/thread_choice.h"
#include "native/xpbd.h"
#include "plan/plan.h"

namespace weft::native {

/// Who computes a step of the plan.
enum class Means {
  sweep,   ///< kernels, together with the other steps of a sweep: Engine::sweep
  effect,  ///< on the cloth's rows, by itself: Engine::run
  look,    ///< of self-collision, from the cloth's rows into buffers: Engine::look
  mirror   ///< the pass's mirror over buffers, its rows split over Engine::threads_for_mirrors
};
Means means_of(const Pass& pass, const Plan& plan);

/// Why native does not run this plan; empty when it does.
std::string unsupported(const Plan& plan);

class Engine {
 public:
  /// @param plan  one that is not unsupported()
  /// @throws Error(Exit::usage) for a kernel that this machine does not have, or a WEFT_THREADS that is no
  /// number
  Engine(const Model& model, const Plan& plan, const EngineOptions& options = {});

  /// Another model of the same grid, with its plan. The state has to be loaded again.
  void adopt(const Model& model, const Plan& plan);
  /// Takes positions and velocities, who is fixed and what is broken.
  void load(const HostBuffers<float>& buffers);
  /// One step of Means::effect, with its row of the schedule.
  void run(const PlanStep& step, const Kick& kick);
  /// One step of Means::look. Where the pass reads positions in the buffers, too (SelfCollision::
  /// reads_buffers), they are those of the rows. Returns whether rows have changed.
  bool look(const Pass& pass, const MirrorContext& context, HostBuffers<float>& buffers);
  /// Before the first of the passes that make lists: whether they are empty and made herewith
  /// (SelfCollision::make_empty_lists).
  bool make_empty_lists(HostBuffers<float>& buffers, const std::function<void()>& need_positions);
  /// Valid until the next call of another function.
  RowThreads& threads_for_mirrors();
  std::span<const std::uint32_t> broken_links() { return cloth_.broken_links(); }
  /// Sweeps rows [first, first + count) of a frame's schedule.
  /// @param kick2  raised to the largest square of a kick [m²/s²], and no LeapWatch is told; null: nobody
  /// asks
  void sweep(const KickTable& table, std::uint32_t first, std::uint32_t count, float* kick2 = nullptr);
  /// Sweeps as many of `most` rows from `first` on as need nobody to look in between (LeapWatch). Returns
  /// how many; 0, with nothing changed, where each has to be swept by itself.
  std::uint32_t sweep_ahead(const KickTable& table, std::uint32_t first, std::uint32_t most);
  /// Before a frame's first substep: whether the cloth is spread out so that self-collision can have nothing
  /// to do in it (SpreadWatch). Then the frame may be swept by sweep_spread, and its words say what they say
  /// after lists that are empty.
  bool begin_spread_frame(HostBuffers<float>& buffers);
  /// Sweeps rows [first, first + count) of such a frame. Returns whether nothing has come near anything; if
  /// not, the frame has to be taken back.
  bool sweep_spread(const KickTable& table, std::uint32_t first, std::uint32_t count);
  /// Everything to where such a frame began.
  void take_back_spread_frame(HostBuffers<float>& buffers);
  /// After one substep's sweep: whether the strain limit, or tear, may have anything to do in it.
  bool links_are_near(const Kick& kick);
  void write_surface(const SurfaceTarget& target);
  const Kernels& kernels() const { return kernels_; }
  std::uint32_t threads() const { return choice_.best(); }
  std::uint64_t bytes() const;

 private:
  Bands& bands(std::uint32_t count);
  Crew& crew(std::uint32_t count);
  LeapWatch* watch();
  /// In all threads, act(first, last) with rows of all cloths.
  template <class Act>
  void share_rows(const Act& act);
  /// What the plan's solver needs beside the cloth.
  void furnish(const Model& model, const Plan& plan);

  Cloth cloth_;
  const Kernels& kernels_;
  std::unique_ptr<Effects> effects_;
  std::unique_ptr<SelfCollision> self_collision_;
  std::unique_ptr<SpreadFrames> spread_;   ///< where frames may be swept without looks at self-collision
  std::unique_ptr<LinkWatch> links_;       ///< where the sweep tells of links
  std::unique_ptr<BodyTouch> body_touch_;  ///< where the sweep touches bodies
  Floats half_velocity_;                   ///< velocity Verlet's
  std::unique_ptr<Xpbd> xpbd_;             ///< the sweeps, where XPBD is the solver
  ThreadChoice choice_;
  ThreadSpeeds speeds_;
  bool allows_spread_frames_;
  std::unique_ptr<Crew> crew_;
  std::optional<CrewRows> crew_rows_;
  std::map<std::uint32_t, std::unique_ptr<Bands>> bands_;  ///< by count, made when first wanted
};

}  // namespace weft::native
