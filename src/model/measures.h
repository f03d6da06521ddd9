// What can be said of a state: energy, stretch, momentum, penetration. Double precision, on the host.
#pragma once
#include <cstdint>

#include "model/model.h"

namespace weft {

struct Energy {
  double kinetic_j = 0, elastic_j = 0, bending_j = 0, gravity_j = 0;
  double total() const { return kinetic_j + elastic_j + bending_j + gravity_j; }
};
Energy energy(const Model&, const State&);

/// Relative elongation |d|/rest − 1 over the structural springs.
struct Stretch {
  double maximum = 0, p99 = 0;
};
Stretch stretch(const Model&, const State&);

/// Least and largest damping ratio c/(2·√(k·m₀/2)) of the kinds of springs that exist; infinite without any.
struct DampingRatios {
  double least = 0, largest = 0;
};
DampingRatios damping_ratios(const Model&);
/// A cloth of this damping ratio loses more than it gains where neighbours fly over one another within a
/// substep (docs/stability.md "Where no bound holds").
inline constexpr double kDampingRatioEnough = 0.03;

glm::dvec3 linear_momentum(const Model&, const State&);
glm::dvec3 angular_momentum(const Model&, const State&);

/// sqrt(mean over particles of |x_a − x_b|²) [m]. Shapes must agree.
double rms_distance(const State& a, const State& b);
double max_distance(const State& a, const State& b);

/// Deepest penetration [m] into a sphere or the floor at the state's time, thickness counted; 0 when outside.
double deepest_penetration(const Model&, const State&);

/// Whether every number is finite; otherwise the first particle that is not.
bool all_finite(const State&, std::uint32_t* first_bad = nullptr);

/// 64-bit FNV-1a over the state rounded to float, −0 counted as +0. The determinism goldens use it.
std::uint64_t state_hash(const State&);

}  // namespace weft
