// The scene that runs in the window: what it is made of, its simulation, its pace, and the hand on it.
// Whatever fails leaves the scene that ran before.
#pragma once
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/reader.h"
#include "sim/gpu_simulation.h"
#include "sim/host_drawn.h"
#include "study/measure.h"
#include "viewer/hand.h"
#include "viewer/pacing.h"
#include "viewer/scene_change.h"
#include "viewer/substep_budget.h"

namespace weft {

/// Where a window's cloth is computed; a Vulkan device draws it in any case.
enum class ComputeOn {
  device,  ///< the device that draws
  native,  ///< the CPU's vector units; what they lack on the reference
};

/// Numbers about the run that the overlay shows.
struct RunFigures {
  double frame_ms = 0.0;     ///< wall time that one simulated frame took, smoothed; 0 until one is computed
  double expected_ms = 0.0;  ///< until then: what the part computed so far leads one to expect
  double rebuild_ms = 0.0;   ///< of the latest change of model
  double max_stretch = 0.0;  ///< read back now and then
  double measured_at_s = -1.0;  ///< simulated time of that reading; negative: none yet
  bool kept_plan = false;       ///< the latest change only rewrote parameters
};

/// One simulated frame as it was read back at both ends, for whoever asked.
struct WatchedFrame {
  State before, after;
  double frame_s = 0.0;
  double cost_ms = 0.0;  ///< what reading both took
};

/// A pin made with P, wherever the cloth was then.
struct HandPin {
  glm::dvec2 at{0.0};       ///< fractions of width and height
  glm::dvec3 place_m{0.0};  ///< where it holds the cloth
  std::uint32_t cloth = 0;  ///< which one
};

class RunningScene {
 public:
  /// @param kernel  one of kernel_names(), or empty for auto; auto takes what is remembered and tries nothing
  /// @throws Error as load_scene and GpuSimulation::create do
  RunningScene(gpu::Device&, SceneOverrides overrides, const std::string& which, std::string kernel = {},
               ComputeOn compute_on = ComputeOn::device);

  /// Opens another scene at its start.
  void open(const std::string& which);
  /// Reads the file again and carries the state over; with `new_shaders` every pipeline is built anew.
  void reload(bool new_shaders);
  /// Back to the start of the scene as it is now set.
  void reset();
  /// Lets a scene that has diverged go on from its last good state, paused.
  void restore();
  /// Changes the scene while it runs; the state is carried over.
  void apply(const Scene& next);
  /// The same without waiting: a thread prepares the change while the scene goes on, and follow_change()
  /// takes it over. Whatever else changes the scene first waits for that.
  void begin_change(const Scene& next);
  /// Once a turn: takes over what is prepared by now. Returns whether the change is done.
  /// @throws Error as apply does; the scene before runs on
  bool follow_change();
  bool changing() const { return change_ != nullptr; }
  /// The scene that is asked for: the one under way, else the one that runs.
  const Scene& wanted() const { return change_ ? change_->next() : scene_; }
  /// Waits for the change and the part of a frame under way, if there are any.
  void settle();
  /// Goes on with another kernel of the pass `integrate`; the state is carried over. One that does not fit a
  /// later scene or resolution gives way to auto there.
  /// @throws Error(Exit::usage), changing nothing, when the name is none or the kernel does not fit now
  void set_kernel(const std::string& name);
  const std::string& kernel() const { return kernel_; }  ///< asked for: "auto", or a name
  /// Pins the cloth around a particle where it is now, or removes every pin that holds it.
  /// @param particle  of the scene that runs, while it is not changing()
  /// @param place_m  where that particle is, for the mark that is drawn there
  void toggle_pin(std::uint32_t particle, const glm::dvec3& place_m);

  /// Lets wall time pass: computes the frames that are due, in chunks, for about `budget_s` at most. Where
  /// the simulation has a thread of its own, that one computes them, now and until the next call.
  void advance(double wall_s, double budget_s);
  /// Nothing is computed from now on until the next advance(), nor by the simulation's own thread.
  void rest();
  /// What is reached of the wanted pace, and the substeps that it takes.
  Pace pace() const;
  /// Wall time [ms] that a frame may take at that pace.
  double allowed_ms() const { return 1e3 * scene_.solver.frame_s / pacer_.speed(); }
  /// Lets XPBD take over from a solver that is too slow, or give back, as the user allowed (stand_in()).
  /// @throws Error as apply does; nothing is taken over then
  void keep_pace();
  XpbdStandIn& stand_in() { return stand_in_; }
  const XpbdStandIn& stand_in() const { return stand_in_; }
  /// Asks for one more frame while paused.
  void step() { ++steps_due_; }
  void set_paused(bool paused);
  bool paused() const { return paused_; }
  /// Takes a new reading of the stretch if the last one is old enough.
  void measure();
  void measure_now();

  /// Asks for the next whole frame's ends. A frame that a hand moves in, or a change cuts, is not taken.
  void watch_next_frame() { watch_wanted_ = true; }
  /// That frame, once, when it is done.
  std::optional<WatchedFrame> take_watched() { return std::exchange(watched_, std::nullopt); }
  /// Forgets what was asked for, and frees it.
  void stop_watching();

  /// The hand takes hold of the cloth, which is not changing(). @param state  as it is now, where `pick` was
  /// found
  void grab(const State& state, const Pick& pick);
  /// The hand lets go, if it holds anything.
  void release();

  const Scene& scene() const { return scene_; }
  /// Where copies of the running cloth, or studies of it, are computed as it is.
  study::Bench bench() const;
  /// The simulation when the device computes it, with its kernel; else null.
  const GpuSimulation* on_gpu() const { return on_gpu_; }
  /// Another simulation of the same kind as the running one.
  std::unique_ptr<DrawnSimulation> copy_of(const Model& model,
                                           const std::shared_ptr<GpuPipelines>& pipelines) const;
  /// What computes, in words; and why, where that is not what was asked for.
  std::string computed_by() const;
  const std::string& why_not_native() const { return native_lacks_; }
  /// The model as it is drawn: without the pins that the hand made, which may be anywhere by now.
  const Model& shown() const { return shown_; }
  std::uint64_t shown_version() const { return shown_version_; }
  const std::vector<std::string>& warnings() const { return warnings_; }
  const std::vector<HandPin>& hand_pins() const { return hand_pins_; }
  const Model& model() const { return simulation_->model(); }
  DrawnSimulation& simulation() { return *simulation_; }
  const DrawnSimulation& simulation() const { return *simulation_; }
  Pacer& pacer() { return pacer_; }
  Hand& hand() { return hand_; }
  const Hand& hand() const { return hand_; }
  const Pacer& pacer() const { return pacer_; }
  const RunFigures& figures() const { return figures_; }
  const std::string& which() const { return which_; }
  std::uint64_t version() const { return version_; }  ///< changes when the simulation object does
  /// Whether the device found the state unsound. The scene then stands at its last good state.
  bool diverged() const { return !divergence_text_.empty(); }
  /// What happened and the likely cause; empty while the scene is sound.
  const std::string& divergence_text() const { return divergence_text_; }
  bool mid_frame() const { return mid_frame_; }
  /// Whether what is drawn now is one moment's: false while the device computes a part of a frame.
  bool showable() const { return !part_under_way_; }

 private:
  using Clock = std::chrono::steady_clock;
  /// The scene with the pins made by hand.
  Scene composed(const Scene& scene) const;
  /// @param anew  build every pipeline again, even for the same plan
  void adopt(const Scene& next, bool keep_state, bool anew = false);
  /// On the device or on the host, as native_lacks_ was found for this model.
  MadeSimulation made(const Model& model) const;
  std::unique_ptr<GpuSimulation> made_on_device(const Model& model) const;
  void take(MadeSimulation next);
  bool keeps_start(const Scene& next) const;
  void settle_in(const Scene& next);
  bool go_on_changing();
  bool carrying() const { return change_ && change_->part() == SceneChange::Part::state; }
  void begin_again();
  void begin_piece();
  void begin_part();
  bool end_part(double wait_s);
  void note_part();
  void finish_part();
  void note_progress(double part_s, double chunk_ms);
  void tell_progress();
  void note_frame(double took_ms);
  bool may_go_on_by_itself() const;
  void go_on_by_itself(double budget_s);
  void take_in(const FramesDone& done);
  void drop_frame();
  void watch_start();
  void watch_end();
  /// Goes back to the last good state and stops there when the device found the present one unsound.
  void stop_if_diverged();

  gpu::Device& device_;
  SceneOverrides overrides_;
  std::string kernel_;
  ComputeOn compute_on_;
  std::string native_lacks_;  ///< why the kernels do not run the latest simulation that was made
  std::string which_;
  Scene scene_;
  Model shown_;
  std::vector<std::string> warnings_;
  std::vector<HandPin> hand_pins_;
  std::shared_ptr<GpuPipelines> pipelines_;
  std::unique_ptr<DrawnSimulation> simulation_;
  GpuSimulation* on_gpu_ = nullptr;         ///< simulation_, when it is one
  HostDrawnSimulation* on_host_ = nullptr;  ///< simulation_, when it is one
  Pacer pacer_;
  XpbdStandIn stand_in_;
  std::optional<std::uint64_t> own_needed_of_;  ///< the shown_version that own_needed_ belongs to
  std::uint32_t own_needed_ = 0;                ///< substeps of the solver that XPBD stands in for
  Hand hand_;
  RunFigures figures_;
  bool paused_ = false, mid_frame_ = false;
  bool more_parts_ = false;      ///< follow the one under way in its frame
  bool part_under_way_ = false;  ///< the device computes it, and nobody waits
  double noted_s_ = 0.0;         ///< simulated time up to which a frame's parts are told of
  double spent_ms_ = 0.0;        ///< on parts since a picture could be made
  bool by_itself_ = false;       ///< the simulation's thread begins frames that are owed
  std::string divergence_text_;
  std::uint32_t pieces_left_ = 0, pieces_ = 1, steps_due_ = 0;
  double frame_wall_ms_ = 0.0, frame_computed_ms_ = 0.0, frame_part_s_ = 0.0;  // of the frame under way
  std::uint64_t version_ = 0, shown_version_ = 0;
  Clock::time_point next_measure_{};
  bool watch_wanted_ = false;
  std::optional<WatchedFrame> under_watch_, watched_;
  /// One that pictures in flight may read, and the device's value when none does.
  struct Retired {
    std::unique_ptr<DrawnSimulation> simulation;
    std::uint64_t read_until = 0;
  };
  std::optional<Retired> retired_;
  std::unique_ptr<SceneChange> change_;  // last: it ends before what it reads
};

}  // namespace weft
