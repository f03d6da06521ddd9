// Depths in colliders, each seen from its own frame.
#include "support/hard_measures.h"

#include <algorithm>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <vector>

#include "model/distance_grid.h"
#include "model/motion.h"
#include "model/solids.h"

namespace weft::hard {
namespace {

/// A collider but the floor: where it is at a time, and how far from its surface a point in its frame is.
struct Body {
  double inner_m;
  std::function<SolidFrame(double time_s)> frame;
  std::function<double(const glm::dvec3& own)> distance_m;
  glm::dvec3 own(const glm::dvec3& x, double time_s) const {
    const SolidFrame at = frame(time_s);
    return glm::transpose(at.axes) * (x - at.center_m);
  }
};

/// Half the thickness of a mesh where it is thickest [m].
double inner_m(const DistanceGrid& grid) { return -double(std::ranges::min(grid.distance)); }

/// The scene's colliders; the model must outlive them.
std::vector<Body> bodies_of(const Model& model) {
  std::vector<Body> bodies;
  for (const SphereSection& sphere : model.scene.spheres)
    bodies.push_back({sphere.radius_m,
                      [&](double t) {
                        return SolidFrame{sphere_center_at(sphere, t), glm::dmat3(1.0)};
                      },
                      [&](const glm::dvec3& own) { return glm::length(own) - sphere.radius_m; }});
  for (const Solid& solid : solids_of(model.scene)) {
    const bool is_box = solid.radius_m == 0.0;
    const glm::dvec3& half = solid.half_m;
    bodies.push_back({is_box ? std::min({half.x, half.y, half.z}) : solid.radius_m,
                      [solid](double t) { return frame_at(solid, t); },
                      [solid](const glm::dvec3& own) {
                        return distance_from(solid, {glm::dvec3(0.0), glm::dmat3(1.0)}, own);
                      }});
  }
  for (std::size_t k = 0; k < model.meshes.size(); ++k)
    bodies.push_back({inner_m(*model.meshes[k]),
                      [&model, k](double t) { return frame_at(model.scene.meshes[k], t); },
                      [&model, k](const glm::dvec3& own) { return distance_at(*model.meshes[k], own); }});
  return bodies;
}

/// Whether the straight way from a to b, in a body's frame, is short and leads through a tenth of it.
bool leads_through(const Body& body, const glm::dvec3& a, const glm::dvec3& b) {
  constexpr int kLooks = 16;
  if (!(glm::distance(a, b) < 0.25 * body.inner_m)) return false;
  for (int look = 0; look <= kLooks; ++look)
    if (body.distance_m(a + (look / double(kLooks)) * (b - a)) < -0.1 * body.inner_m) return true;
  return false;
}

}  // namespace

double deepest_share(const Model& model, const State& state) {
  double deepest = 0.0;
  if (model.scene.floor)
    for (const glm::dvec3& x : state.position)
      deepest = std::max(deepest, -floor_plane(*model.scene.floor).above_m(x) / model.grid.width_m());
  for (const Body& body : bodies_of(model))
    for (std::size_t p = 0; p < state.position.size(); ++p)
      if (model.relative_inverse_mass[p] != 0.0)
        deepest =
            std::max(deepest, -body.distance_m(body.own(state.position[p], state.time_s)) / body.inner_m);
  return deepest;
}

std::uint32_t passed_through(const Model& model, const State& before, const State& after) {
  const std::vector<Body> bodies = bodies_of(model);
  std::uint32_t count = 0;
  for (std::size_t p = 0; p < after.position.size(); ++p) {
    if (model.relative_inverse_mass[p] == 0.0) continue;
    const glm::dvec3 &a = before.position[p], &b = after.position[p];
    const bool through = (model.scene.floor && floor_plane(*model.scene.floor).above_m(b) < -1e-3) ||
                         std::ranges::any_of(bodies, [&](const Body& body) {
                           return leads_through(body, body.own(a, before.time_s), body.own(b, after.time_s));
                         });
    count += through ? 1 : 0;
  }
  return count;
}

}  // namespace weft::hard
