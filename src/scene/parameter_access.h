// How a row of the parameter table reads and writes its member of a scene: `row<section, member>(…)`.
// Internal to src/scene.
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "scene/parameters.h"

namespace weft::parameter_access {

// A section is plain, optional or a list; `part` is the one that `item` means.
template <class Section>
auto& part(Section& section, std::size_t item) {
  if constexpr (requires { section.has_value(); })
    return *section;
  else if constexpr (requires { section[item]; })
    return section[item];
  else
    return section;
}

inline ParameterValue to_value(double field) { return field; }
inline ParameterValue to_value(std::uint32_t field) { return static_cast<double>(field); }
inline ParameterValue to_value(const std::string& field) { return field; }
inline ParameterValue to_value(const glm::dvec2& field) { return field; }
inline ParameterValue to_value(const glm::dvec3& field) { return field; }
inline ParameterValue to_value(const MotionKeys& field) { return field; }
inline ParameterValue to_value(const std::optional<double>& field) {
  return field.value_or(std::numeric_limits<double>::quiet_NaN());
}
inline ParameterValue to_value(Orientation field) {
  return std::string(field == Orientation::vertical ? "vertical" : "horizontal");
}

inline void from_value(Orientation& field, const ParameterValue& value) {
  field = std::get<std::string>(value) == "vertical" ? Orientation::vertical : Orientation::horizontal;
}
inline void from_value(std::uint32_t& field, const ParameterValue& value) {
  field = static_cast<std::uint32_t>(std::get<double>(value));
}
inline void from_value(std::optional<double>& field, const ParameterValue& value) {
  field = std::get<double>(value);
}
template <class T>
void from_value(T& field, const ParameterValue& value) {
  field = std::get<T>(value);
}

template <auto section, auto field>
ParameterValue get_field(const Scene& scene, std::size_t item) {
  return to_value(part(scene.*section, item).*field);
}
template <auto section, auto field>
void set_field(Scene& scene, std::size_t item, const ParameterValue& value) {
  from_value(part(scene.*section, item).*field, value);
}
template <auto section, auto field>
constexpr Parameter row(Parameter parameter) {
  parameter.get = get_field<section, field>;
  parameter.set = set_field<section, field>;
  return parameter;
}

}  // namespace weft::parameter_access
