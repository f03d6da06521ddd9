// Sliders where the table offers a range, number fields elsewhere, choices for words.
#include "viewer/parameter_widgets.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "scene/reader.h"

namespace weft {
namespace {

bool has_slider(const Parameter& parameter) { return parameter.slider_maximum > parameter.slider_minimum; }

const char* number_format(const Parameter& parameter) {
  if (parameter.kind == ParameterKind::integer) return "%.0f";
  return has_slider(parameter) && parameter.slider_maximum <= 0.1 ? "%.6f" : "%.4g";
}

void explain(const Parameter& parameter) {
  if (!ImGui::IsItemHovered()) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(320.0f * ui_scale());
  const std::string text = fmt::format(
      "{}.{}: {}\n{}{}", parameter.section, parameter.key, parameter.about, rule_text(parameter),
      parameter.example.empty() ? std::string() : fmt::format("\nfor example {}", parameter.example));
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

/// Up to three numbers in one row.
bool edit_numbers(const Parameter& parameter, const std::string& label, double* values, int count) {
  const ImGuiSliderFlags flags = parameter.slider_logarithmic ? ImGuiSliderFlags_Logarithmic : 0;
  const double span = std::max(1.0, std::abs(values[0]));
  const char* format = number_format(parameter);
  // ImGui 1.86 leaves a wrong item width behind when its many-component widgets have one component.
  if (has_slider(parameter) && count == 1)
    return ImGui::SliderScalar(label.c_str(), ImGuiDataType_Double, values, &parameter.slider_minimum,
                               &parameter.slider_maximum, format, flags);
  if (has_slider(parameter))
    return ImGui::SliderScalarN(label.c_str(), ImGuiDataType_Double, values, count, &parameter.slider_minimum,
                                &parameter.slider_maximum, format, flags);
  const auto speed = static_cast<float>(0.01 * span);
  if (count == 1)
    return ImGui::DragScalar(label.c_str(), ImGuiDataType_Double, values, speed, nullptr, nullptr, format);
  return ImGui::DragScalarN(label.c_str(), ImGuiDataType_Double, values, count, speed, nullptr, nullptr,
                            format);
}

bool take(const Parameter& parameter, Scene& scene, std::size_t item, const ParameterValue& value) {
  if (!broken_rule(parameter, value).empty()) return false;
  parameter.set(scene, item, value);
  return true;
}

bool edit_word(const Parameter& parameter, Scene& scene, std::size_t item, const std::string& label,
               const std::string& now) {
  bool changed = false;
  if (!ImGui::BeginCombo(label.c_str(), now.c_str())) return false;
  for (std::size_t start = 0; start <= parameter.words.size();) {
    const std::size_t end = std::min(parameter.words.find('|', start), parameter.words.size());
    const std::string word(parameter.words.substr(start, end - start));
    if (ImGui::Selectable(word.c_str(), word == now)) changed = take(parameter, scene, item, word);
    start = end + 1;
  }
  ImGui::EndCombo();
  return changed;
}

bool edit_value(const Parameter& parameter, Scene& scene, std::size_t item, const std::string& label) {
  const ParameterValue now = parameter.get(scene, item);
  if (const auto* word = std::get_if<std::string>(&now)) {
    if (!parameter.words.empty() && parameter.kind == ParameterKind::word)
      return edit_word(parameter, scene, item, label, *word);
    ImGui::LabelText(label.c_str(), "%s", word->empty() ? "none" : word->c_str());
    return false;
  }
  if (std::holds_alternative<MotionKeys>(now)) {  // written in the file; here one sees that they are there
    ImGui::LabelText(label.c_str(), "%s", value_text(now).c_str());
    return false;
  }
  if (const auto* number = std::get_if<double>(&now)) {
    double value = std::isfinite(*number) ? *number : 0.0;
    if (!edit_numbers(parameter, label, &value, 1)) return false;
    return take(parameter, scene, item, parameter.kind == ParameterKind::integer ? std::round(value) : value);
  }
  if (const auto* two = std::get_if<glm::dvec2>(&now)) {
    glm::dvec2 value = *two;
    return edit_numbers(parameter, label, &value.x, 2) && take(parameter, scene, item, value);
  }
  glm::dvec3 value = std::get<glm::dvec3>(now);
  return edit_numbers(parameter, label, &value.x, 3) && take(parameter, scene, item, value);
}

bool always_there(std::string_view section) {
  return section == "cloth" || section == "material" || section == "solver";
}

bool item_widgets(std::string_view section, Scene& scene, std::size_t item) {
  bool changed = false;
  for (const Parameter& parameter : parameters())
    if (parameter.section == section) changed |= parameter_widget(parameter, scene, item);
  return changed;
}

bool list_widgets(std::string_view section, Scene& scene) {
  bool changed = false;
  for (std::size_t item = 0; item < item_count(scene, section); ++item) {
    ImGui::PushID(static_cast<int>(item));
    ImGui::Text("%s %zu", std::string(section).c_str(), item + 1);
    ImGui::SameLine();
    const bool removed = ImGui::SmallButton("remove");
    if (removed) {
      remove_item(scene, section, item);
    } else {
      changed |= item_widgets(section, scene, item);
    }
    ImGui::PopID();
    if (removed) return true;
  }
  if (ImGui::SmallButton("add one")) {
    add_visible_section(scene, section);
    changed = true;
  }
  return changed;
}

}  // namespace

float ui_scale() { return ImGui::GetFontSize() / 14.0f; }

bool parameter_widget(const Parameter& parameter, Scene& scene, std::size_t item, std::string_view label) {
  const std::string_view shown = label.empty() ? parameter.key : label;
  const std::string unit = parameter.unit.empty() ? std::string() : fmt::format(" [{}]", parameter.unit);
  // What follows ## names the widget and is not shown.
  const bool changed = edit_value(parameter, scene, item,
                                  fmt::format("{}{}##{}.{}", shown, unit, parameter.section, parameter.key));
  explain(parameter);
  return changed;
}

void add_visible_section(Scene& scene, std::string_view section) {
  const double cell_m = scene.cloth.width_m / std::max(1.0, scene.cloth.resolution - 1.0);
  const bool was_there = has_section(scene, section);
  if (section == "wind" && !scene.air && !scene.aerodynamics) add_visible_section(scene, "air");
  add_section(scene, section);
  if (section == "air" && !was_there) scene.air->drag_kg_m2_s = 0.1;
  if (section == "wind" && !was_there) scene.wind->velocity_m_s = {0.0, 0.0, 3.0};
  if (section == "self_collision" && !was_there) scene.self_collision->thickness_m = 0.5 * cell_m;
  if (section == "tearing" && !was_there) scene.tearing->strain = 0.3;
  if (section == "cloths")  // clear of the others, so that none starts within another
    scene.cloths.back().center_m =
        scene.cloth.center_m + glm::dvec3(0.0, 0.0, 0.1 * scene.cloth.width_m) * double(scene.cloths.size());
  if (section == "spheres") {
    scene.spheres.back().center_m = scene.cloth.center_m - glm::dvec3(0.0, 0.8 * scene.cloth.height_m, 0.0);
    scene.spheres.back().radius_m = 0.25 * scene.cloth.width_m;
  }
  const glm::dvec3 under_m = scene.cloth.center_m - glm::dvec3(0.0, 0.8 * scene.cloth.height_m, 0.0);
  if (section == "capsules") {
    CapsuleSection& capsule = scene.capsules.back();
    capsule.a_m = under_m - glm::dvec3(0.5 * scene.cloth.width_m, 0.0, 0.0);
    capsule.b_m = under_m + glm::dvec3(0.5 * scene.cloth.width_m, 0.0, 0.0);
    capsule.radius_m = 0.1 * scene.cloth.width_m;
  }
  if (section == "meshes") {
    scene.meshes.back().file = (assets_dir() / "meshes" / "ring.obj").string();
    scene.meshes.back().center_m = under_m;
  }
  if (section == "boxes") {
    scene.boxes.back().center_m = under_m;
    scene.boxes.back().size_m = glm::dvec3(0.4 * scene.cloth.width_m);
  }
}

bool section_widget(std::string_view section, Scene& scene, const std::string& cost) {
  const std::string name(section);
  ImGui::PushID(name.c_str());
  bool changed = false;
  const bool is_list = is_list_section(section);
  bool on = has_section(scene, section);
  if (!always_there(section)) {
    if (ImGui::Checkbox("##on", &on)) {
      on ? add_visible_section(scene, section) : remove_section(scene, section);
      // Wind needs air, and its noise aerodynamics.
      if ((section == "air" || section == "aerodynamics") && !on) {
        if (!scene.air && !scene.aerodynamics) remove_section(scene, "wind");
        if (scene.wind && !scene.aerodynamics) scene.wind->noise_m_s = 0.0;
      }
      changed = true;
    }
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("whether %s is simulated at all", name.c_str());
    ImGui::SameLine();
  }
  std::string shown = is_list ? fmt::format("{} ({})", name, item_count(scene, section)) : name;
  if (on && !cost.empty()) shown += ": " + cost;
  if (ImGui::TreeNodeEx((shown + "###tree").c_str(), on ? 0 : ImGuiTreeNodeFlags_Leaf)) {
    if (on) changed |= is_list ? list_widgets(section, scene) : item_widgets(section, scene, 0);
    ImGui::TreePop();
  }
  if (changed && section == "cloths")  // what held a cloth goes with it
    std::erase_if(scene.pins, [&](const PinSection& pin) { return pin.cloth >= cloth_count(scene); });
  ImGui::PopID();
  return changed;
}

}  // namespace weft
