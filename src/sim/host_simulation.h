// A running cloth whose state lies in the host's memory: frames in parts, what is drawn, changes under way.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "native/surface_target.h"
#include "sim/drawn_simulation.h"

namespace weft {

class HostSimulation : public Simulation {
 public:
  /// advance() in parts: begins a frame, computing nothing yet. What was left of an unfinished one is
  /// dropped; the state stays where that one had come to.
  virtual void begin_frame(double frame_s, std::uint32_t substeps) = 0;
  /// Computes about `wall_s` of it, one substep at least. Returns whether more is left.
  virtual bool continue_frame(double wall_s) = 0;
  /// Of the frame so far.
  virtual FrameStats frame_stats() const = 0;
  /// Positions and vertex normals as they are now, vec4 a particle.
  virtual void write_drawn(const native::SurfaceTarget& target) = 0;
  /// Milliseconds of each plan step in the latest finished frame, in plan order.
  virtual std::vector<double> step_ms() const = 0;
  /// As DrawnSimulation::adopt and place.
  virtual bool adopt(const Model&) = 0;
  virtual void place(std::span<const PlacedParticle>) = 0;
  /// How many take part in a substep by now.
  virtual std::uint32_t threads() const { return 1; }
};

/// The reference: make_cpu_simulation, for whoever runs it in parts.
std::unique_ptr<HostSimulation> make_host_reference(const Model&, const Solver&,
                                                    const std::string& precision);

}  // namespace weft
