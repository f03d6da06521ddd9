// What single keys cannot tell: required keys and contradictions.
#include <glm/geometric.hpp>

#include "core/error.h"
#include "core/text.h"
#include "scene/grid_rule.h"
#include "scene/settings.h"
#include "shared/params.h"

namespace weft {
namespace {

void check_required(const Draft& draft) {
  for (const Parameter& parameter : parameters()) {
    if (!parameter.required) continue;
    for (std::size_t item = 0; item < item_count(draft.scene, parameter.section); ++item) {
      const Target target{parameter.section, item};
      if (draft.is_given(target, parameter.key)) continue;
      if (parameter.key == "center" && draft.is_given(target, "keys")) continue;  // the keys say it
      throw error(Exit::usage, "{}: {} is missing; it must be {} ({})", draft.place_of(target),
                  full_key(target, parameter.key), rule_text(parameter), parameter.example);
    }
  }
}

void check_rows(const Draft& draft) {
  const ClothSection& cloth = draft.scene.cloth;
  const double rows = rows_along_height(cloth);
  if (rows >= 2.0 && rows <= 4096.0) return;
  const char* key = draft.is_given({"cloth"}, "height") ? "height" : "resolution";
  throw error(Exit::usage,
              "{}: cloth.height is {}; at cloth.resolution {} and cloth.width {} that is {} rows of "
              "particles, and it "
              "must be 2 to 4096 ({} cloth.resolution or cloth.height)",
              draft.place_of({"cloth"}, key), short_number(cloth.height_m), cloth.resolution,
              short_number(cloth.width_m), short_number(rows), rows < 2.0 ? "raise" : "lower");
}

void check_pins(const Draft& draft) {
  for (std::size_t k = 0; k < draft.scene.pins.size(); ++k) {
    const PinSection& pin = draft.scene.pins[k];
    if (pin.cloth >= cloth_count(draft.scene))
      throw error(Exit::usage,
                  "{}: pins.{}.cloth is {}; it must be 0 to {}, the number of [[cloths]] (add the cloth)",
                  draft.place_of({"pins", k}, "cloth"), k, pin.cloth, draft.scene.cloths.size());
    const double nearest_m = nearest_particle_m(draft.scene.cloth, pin.at);
    if (nearest_m <= pin_reach_m(pin)) continue;
    const Target target{"pins", k};
    const char* key = draft.is_given(target, "radius") ? "radius" : "at";
    throw error(
        Exit::usage,
        "{}: pins.{}.radius is {} m at {}; it must hold a particle, and the nearest is {} m away (raise the "
        "radius or cloth.resolution)",
        draft.place_of(target, key), k, short_number(pin.radius_m), value_text(ParameterValue(pin.at)),
        short_number(nearest_m));
  }
}

void check_wind(const Draft& draft) {
  const auto& wind = draft.scene.wind;
  if (!wind) return;
  if (!draft.scene.air && !draft.scene.aerodynamics)
    throw error(Exit::usage,
                "{}: [wind] needs [air]; it must have air to act through (add [air] with drag = 0.1, or "
                "[aerodynamics])",
                draft.place_of({"wind"}));
  if (wind->noise_m_s > 0.0 && !draft.scene.aerodynamics)
    throw error(Exit::usage,
                "{}: wind.noise is {} without [aerodynamics]; it must have that to act through (add the line "
                "[aerodynamics], or remove noise)",
                draft.place_of({"wind"}, "noise"), short_number(wind->noise_m_s));
  constexpr double kShortestPeriod_s = 1e-3;
  if (wind->gust > 0.0 && wind->period_s < kShortestPeriod_s)
    throw error(Exit::usage,
                "{}: wind.gust is {} with a period of {} s; it must have {} s or more (add wind.period = 2)",
                draft.place_of({"wind"}, "gust"), short_number(wind->gust), short_number(wind->period_s),
                short_number(kShortestPeriod_s));
}

/// What a motion's keys say already must not be said again beside them.
template <class List>
void check_motion_of(const Draft& draft, std::string_view section, std::string_view one, const List& items) {
  for (std::size_t k = 0; k < items.size(); ++k) {
    const Target target{section, k};
    if (items[k].keys.empty()) continue;
    for (const char* key : {"center", "velocity"})
      if (draft.is_given(target, key))
        throw error(Exit::usage,
                    "{}: {} stands beside {}.{}.keys; it must be one or the other, since the keys say "
                    "where the {} is and how fast (remove {})",
                    draft.place_of(target, key), full_key(target, key), section, k, one, key);
  }
}

void check_motion(const Draft& draft) {
  check_motion_of(draft, "spheres", "sphere", draft.scene.spheres);
  check_motion_of(draft, "capsules", "capsule", draft.scene.capsules);
  check_motion_of(draft, "boxes", "box", draft.scene.boxes);
  check_motion_of(draft, "meshes", "mesh", draft.scene.meshes);
}

/// A wall has no height above the origin, and a ceiling is no floor.
void check_floor(const Draft& draft) {
  if (!draft.scene.floor) return;
  const glm::dvec3& n = draft.scene.floor->normal;
  constexpr double kSteepest = 0.087;  // cos 85°
  if (n.y >= kSteepest * glm::length(n) && n.y > 0.0) return;
  throw error(Exit::usage,
              "{}: floor.normal is {}; it must point upwards and lean at most 85 degrees ([0.2, 1, 0]; "
              "[[boxes]] make walls)",
              draft.place_of({"floor"}, "normal"), value_text(ParameterValue(n)));
}

void check_solids(const Draft& draft) {
  const std::size_t capsules = draft.scene.capsules.size(), count = capsules + draft.scene.boxes.size();
  if (count <= shared::kMaxSolids) return;
  const Target first = capsules > shared::kMaxSolids ? Target{"capsules", shared::kMaxSolids}
                                                     : Target{"boxes", shared::kMaxSolids - capsules};
  throw error(Exit::usage,
              "{}: there are {} capsules and boxes together; it must be at most {} (remove some)",
              draft.place_of(first), count, shared::kMaxSolids);
}

void check_meshes(const Draft& draft) {
  if (draft.scene.meshes.size() <= shared::kMaxMeshes) return;
  throw error(Exit::usage, "{}: there are {} meshes; it must be at most {} (join them into one file)",
              draft.place_of({"meshes", shared::kMaxMeshes}), draft.scene.meshes.size(), shared::kMaxMeshes);
}

/// A pin goes with a sphere that there is, or by keys of its own.
void check_attach(const Draft& draft, std::size_t k) {
  const PinSection& pin = draft.scene.pins[k];
  const Place place = draft.place_of({"pins", k}, "attach");
  if (!attached_sphere(draft.scene, pin))
    throw error(Exit::usage, "{}: pins.{}.attach is {}; it must be {} (add the sphere, or remove attach)",
                place, k, in_quotes(pin.attach),
                draft.scene.spheres.empty()
                    ? "a sphere, and the scene has none"
                    : fmt::format("\"spheres.0\" to \"spheres.{}\"", draft.scene.spheres.size() - 1));
  if (!pin.keys.empty())
    throw error(Exit::usage,
                "{}: pins.{}.attach stands beside pins.{}.keys; it must be one or the other (remove one)",
                place, k, k);
}

void check_moved_pins(const Draft& draft) {
  std::size_t moved = 0;
  for (std::size_t k = 0; k < draft.scene.pins.size(); ++k) {
    const PinSection& pin = draft.scene.pins[k];
    if (!pin.attach.empty()) check_attach(draft, k);
    moved += pin.moves() || pin.release_s ? 1 : 0;
    const char* key = !pin.keys.empty() ? "keys" : !pin.attach.empty() ? "attach" : "release";
    if (moved > shared::kMaxMovedPins)
      throw error(Exit::usage,
                  "{}: pins.{}.{} is of the {}th pin that moves or lets go; it must be at most the {}th "
                  "(join pins that move alike, or leave some still)",
                  draft.place_of({"pins", k}, key), k, key, moved, shared::kMaxMovedPins);
  }
}

void check_cloths(const Draft& draft) {
  if (cloth_count(draft.scene) <= shared::kMaxCloths) return;
  throw error(Exit::usage, "{}: there are {} cloths, [cloth] included; it must be at most {} (remove some)",
              draft.place_of({"cloths", shared::kMaxCloths - 1}), cloth_count(draft.scene),
              shared::kMaxCloths);
}

void check_spheres(const Draft& draft) {
  if (draft.scene.spheres.size() <= shared::kMaxSpheres) return;
  throw error(Exit::usage, "{}: there are {} spheres; it must be at most {} (remove some)",
              draft.place_of({"spheres", shared::kMaxSpheres}), draft.scene.spheres.size(),
              shared::kMaxSpheres);
}

}  // namespace

void check_scene(const Draft& draft) {
  check_required(draft);
  check_rows(draft);
  check_cloths(draft);
  check_pins(draft);
  check_wind(draft);
  check_motion(draft);
  check_moved_pins(draft);
  check_spheres(draft);
  check_solids(draft);
  check_meshes(draft);
  check_floor(draft);
}

}  // namespace weft
