// Frames in which the cloth stays spread out, on a Vulkan device: their commands without self-collision's
// passes, what the looks in them found, and the way back where that proves nothing.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "plan/spread_frame.h"
#include "plan/spread_watch.h"
#include "shared/spread.h"
#include "sim/frame_commands.h"
#include "sim/gpu_program.h"

namespace weft {

class GpuSpreadFrames {
 public:
  /// @param plan  that has_spread_frames; its buffers are there. The device and the buffers outlive this.
  GpuSpreadFrames(gpu::Device&, const Model&, const Plan& plan, GpuBuffers&,
                  const std::shared_ptr<GpuPipelines>&, const Kernel&);

  /// A frame's commands for one interval of looks.
  struct Commands {
    /// @param whole  the plan that the frame is one of
    Commands(gpu::Device&, const Plan& whole, Plan frame, const GpuProgram&);
    Plan plan;
    std::vector<std::size_t> step_of;  ///< of the whole plan, whose time each step's is counted as
    FrameCommands recorded;
  };
  /// Whether to compute the frame that begins so, and then by which commands; null: not so. The slot's table
  /// is written, and the state's other half may be written into.
  Commands* begin_frame(Parity parity, std::uint32_t slot, double drift_s, std::uint32_t substeps);
  /// Place of the first of the frame's dispatches that keep what they find: before them it has to be proven.
  static std::uint32_t proven_before(const DispatchOrder& order);
  /// Once those before it are done: whether nothing can have been near anything else in the frame.
  bool stayed_spread();
  /// The frame's start again, which keep_sound kept.
  void take_back(Parity parity);
  /// Milliseconds by the wall clock of looks at a frame's start and of taking back, since this was last
  /// asked.
  double take_host_ms() { return std::exchange(host_ms_, 0.0); }
  /// The state was changed, or the frame was computed otherwise: what was found before says nothing of it.
  void forget() { known_ = false; }

 private:
  bool was_held();
  void look_at_start(Parity parity, std::uint32_t slot);
  void look(Parity parity, std::uint32_t slot);
  void read_found();
  void write_words(double kick_most_m_s);
  void choose_plane();
  void choose_widest(double margin);
  SpreadState found() const;
  bool holds_between(const SpreadState& worst, std::uint32_t substeps) const;
  void end_frame(bool stayed);

  gpu::Device& device_;
  GpuBuffers& buffers_;
  const Model& model_;
  const Plan& plan_;
  SpreadWatch watch_;
  GpuProgram program_;
  bool shares_motion_;
  std::map<std::uint32_t, std::unique_ptr<Commands>> commands_;  ///< by interval
  std::vector<std::uint32_t> words_ =
      std::vector<std::uint32_t>(shared::kSpreadStateWords);  ///< of spread_state, as last read or written
  bool known_ = false;                                        ///< words_ say how the frame that begins starts
  bool has_plane_ = false;
  std::uint32_t widest_ = 0,
                narrow_frames_ = 0;  ///< margin that looks ask for; frames with less than the widest
  double kick_m_s_ = 0.0;            ///< the largest change of a velocity in a substep lately
  double caution_ = 2.0;             ///< how much more it may be
  double hurry_ = 1.0;               ///< how much of a margin is taken to be there all the frame
  double drift_s_ = 0.0, kick_most_m_s_ = 0.0;  ///< of the frame under way
  std::uint32_t interval_ = 0;
  double host_ms_ = 0.0;
  std::uint32_t held_back_ = 0;  ///< times, when a frame computed otherwise was last looked at
};

}  // namespace weft
