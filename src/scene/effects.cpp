// The list of effects. A new optional section takes a row here; a test holds the two together.
#include "scene/effects.h"

#include <algorithm>
#include <array>

#include "core/error.h"
#include "scene/parameters.h"
#include "scene/reader.h"

namespace weft {
namespace {

double cell_m(const Scene& scene) { return scene.cloth.width_m / (scene.cloth.resolution - 1); }

double far_below_m(const Scene& scene) { return scene.cloth.center_m.y - kEffectFar_m; }

constexpr std::array kEffectList{
    Effect{.name = "bend",
           .needs = "",
           .add = [](Scene& s) { s.material.set_bend(2e-5); },
           .remove = [](Scene& s) { s.material.set_bend(0.0); },
           .present = [](const Scene& s) { return s.material.bends(); }},
    Effect{.name = "damping",
           .needs = "",
           .add = [](Scene& s) { s.material.damping_s = 1e-4; },
           .remove = [](Scene& s) { s.material.damping_s = 0.0; },
           .present = [](const Scene& s) { return s.material.damping_s > 0.0; }},
    Effect{.name = "strain_limit",
           .needs = "",
           .add = [](Scene& s) { s.material.strain_limit = 1.0; },
           .remove = [](Scene& s) { s.material.strain_limit = 0.0; },
           .present = [](const Scene& s) { return s.material.strain_limit > 0.0; }},
    Effect{.name = "pins",
           .needs = "",
           .add =
               [](Scene& s) {
                 s.pins = {{{0.0, 0.0}}, {{1.0, 0.0}}};
               }},
    Effect{.name = "gravity", .needs = "", .add = [](Scene& s) { s.gravity = GravitySection{}; }},
    Effect{.name = "air", .needs = "", .add = [](Scene& s) { s.air = AirSection{0.1}; }},
    Effect{.name = "wind",
           .needs = "air",
           .add =
               [](Scene& s) {
                 s.wind = WindSection{{0.0, 0.0, 1.0}};
               }},
    Effect{
        .name = "aerodynamics", .needs = "", .add = [](Scene& s) { s.aerodynamics = AerodynamicsSection{}; }},
    Effect{.name = "floor", .needs = "", .add = [](Scene& s) { s.floor = FloorSection{far_below_m(s)}; }},
    Effect{.name = "spheres",
           .needs = "",
           .add =
               [](Scene& s) {
                 s.spheres = {{.center_m = {0.0, far_below_m(s), 0.0}, .radius_m = 0.25}};
               }},
    Effect{.name = "capsules",
           .needs = "",
           .add =
               [](Scene& s) {
                 CapsuleSection capsule;
                 capsule.a_m = {-0.5, far_below_m(s), 0.0};
                 capsule.b_m = {0.5, far_below_m(s), 0.0};
                 capsule.radius_m = 0.1;
                 s.capsules = {capsule};
               }},
    Effect{.name = "boxes",
           .needs = "",
           .add =
               [](Scene& s) {
                 BoxSection box;
                 box.center_m = {0.0, far_below_m(s), 0.0};
                 box.size_m = glm::dvec3(0.5);
                 s.boxes = {box};
               }},
    Effect{.name = "meshes",
           .needs = "",
           .add =
               [](Scene& s) {
                 MeshSection mesh;
                 mesh.file = (assets_dir() / "meshes" / "ring.obj").string();
                 mesh.center_m = {0.0, far_below_m(s), 0.0};
                 mesh.resolution = 16;
                 s.meshes = {mesh};
               }},
    Effect{.name = "self_collision",
           .needs = "",
           .add = [](Scene& s) { s.self_collision = SelfCollisionSection{0.5 * cell_m(s)}; }},
    Effect{.name = "tethers",
           .needs = "pins",
           .add = [](Scene& s) { s.tethers = TethersSection{10.0}; },
           .solver = "xpbd"},
    Effect{.name = "tearing",
           .needs = "",
           .add = [](Scene& s) { s.tearing = TearingSection{10.0}; },
           .not_with = "strain_limit"},
};

void take_out(Scene& scene, const Effect& effect) {
  if (effect.remove != nullptr)
    effect.remove(scene);
  else
    remove_section(scene, effect.name);
}

}  // namespace

std::span<const Effect> effects() { return kEffectList; }

const Effect& find_effect(std::string_view name) {
  const auto* effect = std::ranges::find(kEffectList, name, &Effect::name);
  if (effect == kEffectList.end()) throw error(Exit::internal, "\"{}\" is no effect", name);
  return *effect;
}

bool stand_together(const Effect& a, const Effect& b) {
  return a.solver.empty() && b.solver.empty() && a.not_with != b.name && b.not_with != a.name;
}

bool has_effect(const Scene& scene, const Effect& effect) {
  return effect.present != nullptr ? effect.present(scene) : has_section(scene, effect.name);
}

std::vector<std::string> effects_of(const Scene& scene) {
  std::vector<std::string> names;
  for (const Effect& effect : kEffectList)
    if (has_effect(scene, effect)) names.emplace_back(effect.name);
  return names;
}

Scene with_effect(Scene scene, std::string_view name) {
  const Effect& effect = find_effect(name);
  if (!effect.needs.empty()) scene = with_effect(std::move(scene), effect.needs);
  if (!has_effect(scene, effect)) effect.add(scene);
  return scene;
}

Scene without_effect(Scene scene, std::string_view name) {
  take_out(scene, find_effect(name));
  for (const Effect& other : kEffectList)
    if (other.needs == name) take_out(scene, other);
  return scene;
}

}  // namespace weft
