// Where the particles of a scene's cloth start: enough of the grid rule of docs/physics.md to check pins and
// colliders before anything is built.
#pragma once
#include <glm/vec2.hpp>
#include <vector>

#include "scene/scene.h"

namespace weft {

/// Edge of a square cell [m].
double cell_m(const ClothSection& cloth);

/// Particles along the height as a whole number, possibly outside of what is allowed.
double rows_along_height(const ClothSection& cloth);

/// Distance [m] from a pin's point to the nearest particle of the flat cloth. Needs 2 or more rows.
double nearest_particle_m(const ClothSection& cloth, glm::dvec2 at);

/// A pin holds what is at most this far [m] from its point.
inline double pin_reach_m(const PinSection& pin) { return pin.radius_m * (1.0 + 1e-6); }

/// How deep [m] the start lies below the floor and inside each sphere; 0 or less where it does not.
struct StartDepths {
  double floor_m = 0.0;
  std::vector<double> sphere_m;
};

/// The deepest particle, imperfection counted; `half_thickness_m` is added to every collider.
StartDepths start_depths(const Scene& scene, double half_thickness_m);

}  // namespace weft
