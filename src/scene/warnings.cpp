// What a scene may say and looks like a mistake: starts inside colliders, pulled apart, or too far away for a
// float.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "core/text.h"
#include "scene/grid_rule.h"
#include "scene/settings.h"

namespace weft {
namespace {

// A cloth laid exactly on the floor is no mistake, though its last bit may be below.
constexpr double kRoundOff_m = 1e-9;

// A float's last bit may be so much of a cell: 0.1 % of strain, more than most cloth has from its weight.
constexpr double kBitOfCell = 1e-3;

using Warnings = std::vector<std::string>;

void warn_of_wind(const Draft& draft, Warnings& warnings) {
  const Scene& scene = draft.scene;
  if (scene.air && scene.wind && scene.air->drag_kg_m2_s == 0.0 && !scene.aerodynamics)
    warnings.push_back(
        fmt::format("{}: air.drag is 0, so the wind moves nothing", draft.place_of({"air"}, "drag")));
}

void warn_of_depths(const Draft& draft, Warnings& warnings) {
  const Scene& scene = draft.scene;
  if (!scene.floor && scene.spheres.empty()) return;
  const double half_thickness_m = scene.self_collision ? 0.5 * scene.self_collision->thickness_m : 0.0;
  const StartDepths depths = start_depths(scene, half_thickness_m);
  if (depths.floor_m > kRoundOff_m)
    warnings.push_back(fmt::format("{}: the cloth starts up to {} m below the floor; raise cloth.center",
                                   draft.place_of({"floor"}, "height"), short_number(depths.floor_m)));
  for (std::size_t k = 0; k < depths.sphere_m.size(); ++k)
    if (depths.sphere_m[k] > kRoundOff_m)
      warnings.push_back(fmt::format("{}: the cloth starts up to {} m inside spheres.{}; move one of them",
                                     draft.place_of({"spheres", k}), short_number(depths.sphere_m[k]), k));
}

/// A pin is at time 0 where its first key says: what it holds is there, and its neighbours are not.
void warn_of_first_keys(const Draft& draft, Warnings& warnings) {
  const double cell = cell_m(draft.scene.cloth);
  for (std::size_t k = 0; k < draft.scene.pins.size(); ++k) {
    const MotionKeys& keys = draft.scene.pins[k].keys;
    const double offset_m = keys.empty() ? 0.0 : glm::length(keys.front().place_m);
    if (offset_m <= cell) continue;
    warnings.push_back(fmt::format(
        "{}: pins.{}.keys begins {} m from where the pin holds the cloth, which is {} cells; the cloth "
        "starts "
        "pulled apart by that (begin with offset = [0, 0, 0], or move cloth.center)",
        draft.place_of({"pins", k}, "keys"), k, short_number(offset_m), short_number(offset_m / cell)));
  }
}

/// The farthest from the origin that the cloth starts, or that a pin takes some of it [m].
double farthest_m(const Scene& scene) {
  double center_m = 0.0;
  for (std::size_t k = 0; k < cloth_count(scene); ++k)
    center_m = std::max(center_m, glm::length(cloth_of(scene, k).center_m));
  const double reach_m = center_m + 0.5 * std::hypot(scene.cloth.width_m, scene.cloth.height_m);
  double carried_m = 0.0;
  for (const PinSection& pin : scene.pins)
    for (const MotionKey& key : pin.keys) carried_m = std::max(carried_m, glm::length(key.place_m));
  return reach_m + carried_m;
}

void warn_of_rounding(const Draft& draft, Warnings& warnings) {
  const Scene& scene = draft.scene;
  const double far_m = farthest_m(scene), cell = cell_m(scene.cloth);
  const double bit_m = std::ldexp(1.0, std::ilogb(far_m) - 23);  // of a float there
  if (scene.solver.precision == "f64" || bit_m <= kBitOfCell * cell) return;
  warnings.push_back(fmt::format(
      "{}: the cloth comes up to {} m from the origin, where a float's last bit is {} m; it should be at "
      "most "
      "{} of a cell of {} m, since it strains every spring by so much (move the scene to the origin, or set "
      "solver.precision to \"f64\")",
      draft.place_of({"cloth"}, "center"), short_number(far_m), short_number(bit_m), short_number(kBitOfCell),
      short_number(cell)));
}

}  // namespace

std::vector<std::string> scene_warnings(const Draft& draft) {
  Warnings warnings;
  for (auto* warn : {warn_of_wind, warn_of_depths, warn_of_first_keys, warn_of_rounding})
    warn(draft, warnings);
  return warnings;
}

}  // namespace weft
