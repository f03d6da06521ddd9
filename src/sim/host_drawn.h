// A cloth that the CPU computes, drawn by a Vulkan device: a thread of its own computes and writes positions
// and normals straight into the mapped vertex buffers that are drawn.
#pragma once
#include <memory>

#include "gpu/device.h"
#include "sim/host_simulation.h"

namespace weft {

/// Equal frames that wall time asks for, one after the other.
struct OwedFrames {
  double frame_s = 0.0;        ///< simulated, each
  std::uint32_t substeps = 0;  ///< each
  double period_s = 0.0;       ///< wall time from one to the next
  double owed = 0.0;           ///< how many are owed now, those done since the latest look still counted
};

/// What the thread did by itself since the latest look.
struct FramesDone {
  std::uint32_t frames = 0;  ///< whole ones
  double computed_ms = 0.0;  ///< wall time that the thread spent on them, what is drawn of them included
  bool under_way = false;    ///< another one is begun
  double part_s = 0.0;       ///< simulated so far of that one
  double part_ms = 0.0;      ///< wall time of that part
};

/// A drawn simulation whose thread can go on by itself while the window paints: it begins each frame when it
/// is owed and keeps the latest whole one ready to be shown. The frames, and so the bits, are the same.
class HostDrawnSimulation : public DrawnSimulation {
 public:
  /// From now on, or still, frames are begun by themselves, for kAhead_s of wall time at most until the next
  /// look. None is begun after one that diverged. read() and what else only looks goes between two parts and
  /// lets the thread go on; what changes the state ends it, and drops what is left of a frame under way.
  virtual FramesDone go_on(const OwedFrames&) = 0;
  /// Ends that between two parts. A frame under way stays so, for continue_frame() or go_on().
  virtual FramesDone stay() = 0;
  /// Makes draw_buffers() show the latest whole frame, or what refresh_normals() showed last where that is
  /// later. Waits that long for a new one. Returns whether there was one.
  virtual bool show_latest(double wait_s) = 0;
  /// Asks for a picture of the middle of the frame under way; a later show_latest() shows it. Does not wait.
  virtual void want_middle() = 0;
  /// Wall time [ms] that the thread spent on the latest finished frame.
  virtual double latest_frame_ms() const = 0;

  static constexpr double kAhead_s = 0.25;
};

/// Takes the simulation over. advance() and the parts of a frame run on the thread; everything else first
/// stops it between two parts.
std::unique_ptr<HostDrawnSimulation> draw_host_simulation(gpu::Device& device,
                                                          std::unique_ptr<HostSimulation> simulation);

}  // namespace weft
