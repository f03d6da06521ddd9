// The parameters that are more than one member of a scene: how they are read and written. Internal to
// src/scene.
#pragma once
#include "scene/parameter_access.h"
#include "scene/parameters.h"

namespace weft::parameter_access {

inline ParameterValue get_title(const Scene& scene, std::size_t) { return scene.title; }
inline void set_title(Scene& scene, std::size_t, const ParameterValue& value) {
  scene.title = std::get<std::string>(value);
}

inline ParameterValue get_shear(const Scene& scene, std::size_t) { return scene.material.shear(); }
inline void set_shear(Scene& scene, std::size_t, const ParameterValue& value) {
  scene.material.shear_n_m = std::get<double>(value);
}

// What a further cloth says itself, or [cloth].
template <auto own, auto of_cloth>
constexpr Parameter cloth_default_row(Parameter parameter) {
  parameter.get = [](const Scene& scene, std::size_t item) {
    return to_value((scene.cloths[item].*own).value_or(scene.cloth.*of_cloth));
  };
  parameter.set = [](Scene& scene, std::size_t item, const ParameterValue& value) {
    auto& field = scene.cloths[item].*own;
    from_value(field.emplace(), value);
  };
  parameter.default_text = "that of [cloth]";
  return parameter;
}

// What a direction has: its own value, or the one of both.
template <auto value, auto field>
constexpr Parameter direction_row(Parameter parameter) {
  parameter.get = [](const Scene& scene, std::size_t) -> ParameterValue { return (scene.material.*value)(); };
  parameter.set = [](Scene& scene, std::size_t, const ParameterValue& number) {
    scene.material.*field = std::get<double>(number);
  };
  return parameter;
}

inline ParameterValue get_sphere_keys(const Scene& scene, std::size_t item) {
  return scene.spheres[item].keys;
}
inline void set_sphere_keys(Scene& scene, std::size_t item, const ParameterValue& value) {
  SphereSection& sphere = scene.spheres[item];
  sphere.keys = std::get<MotionKeys>(value);
  if (!sphere.keys.empty()) sphere.center_m = sphere.keys.front().place_m;
}

inline ParameterValue get_substeps(const Scene& scene, std::size_t) {
  if (scene.solver.substeps == 0) return std::string("auto");
  return static_cast<double>(scene.solver.substeps);
}
inline void set_substeps(Scene& scene, std::size_t, const ParameterValue& value) {
  const double* count = std::get_if<double>(&value);
  scene.solver.substeps = count != nullptr ? static_cast<std::uint32_t>(*count) : 0;
}

}  // namespace weft::parameter_access
