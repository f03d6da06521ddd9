// The panel at the left edge: scenes, time, sliders for what matters most, every parameter, the picture.
#include "viewer/panels.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "scene/parameters.h"
#include "viewer/parameter_widgets.h"

namespace weft {
namespace {

void tooltip(const char* text) {
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text);
}

/// A strength that scales a vector and keeps its direction.
bool strength_slider(const char* label, glm::dvec3& vector, const glm::dvec3& otherwise, float most) {
  float strength = static_cast<float>(glm::length(vector));
  if (!ImGui::SliderFloat(label, &strength, 0.0f, most, "%.2f")) return false;
  const double length = glm::length(vector);
  const glm::dvec3 direction = length > 1e-9 ? vector / length : otherwise;
  vector = direction *
           std::max(static_cast<double>(strength), 1e-6);  // a little is left: the direction stays known
  return true;
}

/// The slider of an effect that is off: it stands at 0, and moving it switches the effect on with that much.
template <class SwitchOn>
bool off_slider(const char* label, float most, SwitchOn&& switch_on) {
  float strength = 0.0f;
  if (!ImGui::SliderFloat(label, &strength, 0.0f, most, "off") || strength <= 0.0f) return false;
  switch_on(static_cast<double>(strength));
  return true;
}

bool row(Scene& scene, std::string_view section, std::string_view key, std::string_view label) {
  const Parameter* parameter = find_parameter(section, key);
  return parameter != nullptr && parameter_widget(*parameter, scene, 0, label);
}

/// Beside the last widget: what it costs, if that is known.
void cost(const PanelFacts& facts, const char* effect) {
  const std::string text = facts.costs != nullptr ? facts.costs->text(effect) : std::string();
  if (text.empty()) return;
  ImGui::SameLine();
  ImGui::TextDisabled("%s", text.c_str());
}

bool resolution_slider(Scene& scene, PanelWishes& wishes) {
  int resolution = static_cast<int>(scene.cloth.resolution);
  const bool changed =
      ImGui::SliderInt("resolution", &resolution, 16, 1024, "%d", ImGuiSliderFlags_Logarithmic);
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  wishes.resolution_slider = {low.x, low.y, low.x + ImGui::CalcItemWidth(), high.y};
  tooltip("particles along the width; the shape is carried over, the material stays the same cloth");
  if (changed) scene.cloth.resolution = static_cast<std::uint32_t>(std::clamp(resolution, 2, 4096));
  return changed;
}

/// One slider, or one a direction where the material tells warp and weft apart.
bool membrane_sliders(Scene& scene) {
  if (!scene.material.membrane_warp_n_m && !scene.material.membrane_weft_n_m)
    return row(scene, "material", "membrane", "membrane");
  const bool warp = row(scene, "material", "membrane_warp", "membrane, warp");
  return row(scene, "material", "membrane_weft", "membrane, weft") || warp;
}

/// Bending may be switched off altogether: 0 is below a logarithmic slider's end.
bool bending_slider(Scene& scene) {
  bool on = scene.material.bends(), changed = false;
  if (ImGui::Checkbox("##bend", &on)) {
    scene.material.set_bend(on ? 1e-5 : 0.0);
    changed = true;
  }
  tooltip("whether the cloth resists bending");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(ImGui::CalcItemWidth() - ImGui::GetFrameHeight() - ImGui::GetStyle().ItemSpacing.x);
  const MaterialSection& m = scene.material;
  if (on && (m.bend_warp_n_m || m.bend_weft_n_m)) {
    changed |= row(scene, "material", "bend_warp", "bending, warp");
    return row(scene, "material", "bend_weft", "bending, weft") || changed;
  }
  if (on) return row(scene, "material", "bend", "bending") || changed;
  ImGui::TextDisabled("bending is off");
  return changed;
}

/// Wind, drag and gravity. The label of a slider stays the same when moving it switches its effect on.
bool force_sliders(Scene& scene, const PanelFacts& facts) {
  constexpr double kAway = 1.0, kDown = -1.0;  // along z and y, where no direction was ever given
  bool changed = false;
  if (scene.wind) {
    changed |= strength_slider("wind [m/s]", scene.wind->velocity_m_s, {0.0, 0.0, kAway}, 20.0f);
  } else {
    changed |= off_slider("wind [m/s]", 20.0f, [&](double strength) {
      add_visible_section(scene, "wind");
      scene.wind->velocity_m_s = {0.0, 0.0, kAway * strength};
    });
  }
  tooltip("strength of the mean wind; its direction is under wind below");
  cost(facts, "wind");
  if (scene.air) {
    changed |= row(scene, "air", "drag", "drag");
  } else if (const Parameter* drag = find_parameter("air", "drag")) {
    changed |= off_slider("drag [kg/(m²·s)]##air.drag", static_cast<float>(drag->slider_maximum),
                          [&](double strength) {
                            add_visible_section(scene, "air");
                            scene.air->drag_kg_m2_s = strength;
                          });
  }
  cost(facts, "air");
  if (scene.gravity) {
    changed |= strength_slider("gravity [m/s²]", scene.gravity->acceleration_m_s2, {0.0, kDown, 0.0}, 25.0f);
  } else {
    changed |= off_slider("gravity [m/s²]", 25.0f, [&](double strength) {
      add_visible_section(scene, "gravity");
      scene.gravity->acceleration_m_s2 = {0.0, kDown * strength, 0.0};
    });
  }
  tooltip("strength; its direction is under gravity below");
  cost(facts, "gravity");
  return changed;
}

bool substeps_slider(Scene& scene, std::uint32_t running) {
  bool automatic = scene.solver.substeps == 0, changed = false;
  if (ImGui::Checkbox("auto##substeps", &automatic)) {
    scene.solver.substeps = automatic ? 0 : running;
    changed = true;
  }
  tooltip("follow the largest stable step; a number below it may blow the cloth up");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(ImGui::CalcItemWidth() - ImGui::GetCursorPosX() +
                          ImGui::GetStyle().WindowPadding.x);
  int substeps = static_cast<int>(automatic ? running : scene.solver.substeps);
  if (automatic) {
    ImGui::LabelText("substeps a frame", "%d", substeps);
  } else if (ImGui::SliderInt("substeps a frame", &substeps, 1, 2000, "%d", ImGuiSliderFlags_Logarithmic)) {
    scene.solver.substeps = static_cast<std::uint32_t>(std::max(substeps, 1));
    changed = true;
  }
  return changed;
}

void kernel_choice(const RunningScene& running, const PanelFacts& facts, PanelWishes& wishes) {
  if (running.on_gpu() == nullptr) return;
  const std::string& asked = running.kernel();
  const std::string running_now = describe(running.on_gpu()->kernel().kernel);
  const std::string shown = asked == "auto" ? "auto: " + running_now : running_now;
  if (ImGui::BeginCombo("kernel", shown.c_str())) {
    if (ImGui::Selectable("auto", asked == "auto")) wishes.kernel = "auto";
    for (const std::string& name : facts.kernels)
      if (ImGui::Selectable(name.c_str(), name == asked)) wishes.kernel = name;
    ImGui::EndCombo();
  }
  tooltip("how the device computes a substep; all end in the same bits and differ in speed");
  if (!facts.trying.empty()) ImGui::TextDisabled("timing %s", facts.trying.c_str());
}

/// Whether XPBD may take over, and why it would not.
void stand_in_switch(const RunningScene& running, PanelWishes& wishes) {
  bool allowed = running.stand_in().allowed();
  if (ImGui::Checkbox("xpbd when too slow", &allowed)) wishes.allow_xpbd = allowed;
  const std::string why_not = running.stand_in().active() ? "" : why_no_stand_in(running.scene());
  tooltip(
      fmt::format("where the substeps do not fit into real time, take XPBD: fast, stable and too soft. Off: "
                  "slow motion with the same physics{}{}",
                  why_not.empty() ? "" : "; here it would not: ", why_not)
          .c_str());
}

void scene_buttons(const RunningScene& running, const PanelFacts& facts, PanelWishes& wishes) {
  for (std::size_t k = 0; k < std::min<std::size_t>(facts.scenes.size(), 6); ++k) {
    if (k > 0) ImGui::SameLine();
    const std::string number = std::to_string(k + 1);
    const bool is_open = running.scene().title == facts.scenes[k].title;
    if (is_open) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
    if (ImGui::Button(number.c_str(), {38.0f * ui_scale(), 0.0f})) wishes.open = number;
    if (is_open) ImGui::PopStyleColor();
    tooltip(facts.scenes[k].title.c_str());
  }
  ImGui::TextWrapped("%s", running.scene().title.c_str());
}

}  // namespace

void Panels::time_controls(const RunningScene& running, PanelWishes& wishes) {
  wishes.toggle_pause |= ImGui::Button(running.paused() ? "Go on" : "Pause", {74.0f * ui_scale(), 0.0f});
  ImGui::SameLine();
  ImGui::BeginDisabled(!running.paused());
  wishes.step |= ImGui::Button("Step", {74.0f * ui_scale(), 0.0f});
  ImGui::EndDisabled();
  ImGui::SameLine();
  wishes.reset |= ImGui::Button("Reset", {74.0f * ui_scale(), 0.0f});
  float speed = static_cast<float>(running.pacer().speed());
  if (ImGui::SliderFloat("speed", &speed, 0.05f, 4.0f, "%.2f x", ImGuiSliderFlags_Logarithmic))
    wishes.speed = std::clamp(static_cast<double>(speed), 0.01, 16.0);
  tooltip("simulated over real time; the time step stays the same");
}

void Panels::quick_sliders(Scene& scene, bool& changed, const PanelFacts& facts, PanelWishes& wishes) {
  changed |= resolution_slider(scene, wishes);
  changed |= membrane_sliders(scene);
  changed |= row(scene, "material", "shear", "shear");
  changed |= bending_slider(scene);
  cost(facts, "bend");
  changed |= force_sliders(scene, facts);
  bool apart = scene.self_collision.has_value();
  if (ImGui::Checkbox("self-collision", &apart)) {
    apart ? add_visible_section(scene, "self_collision") : remove_section(scene, "self_collision");
    changed = true;
  }
  tooltip("whether the cloth's layers keep apart");
  cost(facts, "self_collision");
  if (scene.self_collision) changed |= row(scene, "self_collision", "thickness", "thickness");
}

/// Asks for a trial of what is folded into passes with others; its progress while it runs.
void Panels::trial_controls(const PanelFacts& facts, PanelWishes& wishes) {
  if (facts.costs == nullptr) return;
  if (const EffectTrial* trial = facts.costs->trial()) {
    wishes.stop_measuring = ImGui::Button("Stop", {74.0f * ui_scale(), 0.0f});
    ImGui::SameLine();
    ImGui::Text("measuring, %zu of %zu", trial->done(), trial->total());
    return;
  }
  wishes.measure_effects = ImGui::Button("Measure what each effect costs", {-1.0f, 0.0f});
  tooltip(
      "An effect with passes of its own shows its milliseconds at any time. The others are folded into "
      "one pass: this runs some frames with and without each, on copies, which takes a few seconds.");
}

void Panels::all_parameters(Scene& scene, bool& changed, const PanelFacts& facts, PanelWishes& wishes) {
  if (ImGui::BeginCombo("material",
                        scene.material.preset.empty() ? "the scene's own" : scene.material.preset.c_str())) {
    for (const AssetInfo& material : facts.materials) {
      if (ImGui::Selectable(material.name.c_str(), material.name == scene.material.preset))
        wishes.material = material.name;
      if (!material.title.empty()) tooltip(material.title.c_str());
    }
    ImGui::EndCombo();
  }
  for (const std::string_view section : section_names())
    if (!section.empty() && section != "expect") {
      const std::string name(section);
      changed |= section_widget(section, scene, facts.costs != nullptr ? facts.costs->text(name) : "");
    }
  trial_controls(facts, wishes);
}

void Panels::picture_controls(const PanelFacts& facts, ViewState& view, PanelWishes& wishes) {
  bool smooth = view.look.shading == Shading::smooth;
  if (ImGui::Checkbox("smooth", &smooth)) view.look.shading = smooth ? Shading::smooth : Shading::flat;
  tooltip(facts.costs != nullptr
              ? fmt::format("off: flat shading, half of the triangles; the normals take {} in either case",
                            facts.costs->text("normals"))
                    .c_str()
              : "off: flat shading, half of the triangles");
  ImGui::SameLine();
  ImGui::Checkbox("wireframe", &view.look.wireframe);
  ImGui::SameLine();
  ImGui::Checkbox("strain", &view.look.heat);
  tooltip("colour by strain");
  if (view.look.heat) {
    float percent = static_cast<float>(100.0 * view.look.heat_full);
    if (ImGui::SliderFloat("full colour at [%]", &percent, 0.1f, 100.0f, "%.1f",
                           ImGuiSliderFlags_Logarithmic))
      view.look.heat_full = 0.01 * percent;
  }
  bool automatic = facts.automatic_scale;
  if (ImGui::Checkbox("auto##scale", &automatic)) wishes.scale = automatic ? 0.0 : facts.scale;
  tooltip("draw fewer pixels when drawing is slow");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(ImGui::CalcItemWidth() - ImGui::GetCursorPosX() +
                          ImGui::GetStyle().WindowPadding.x);
  float percent = static_cast<float>(100.0 * facts.scale);
  ImGui::BeginDisabled(automatic);
  if (ImGui::SliderFloat("sharpness [%]", &percent, 25.0f, 100.0f, "%.0f")) wishes.scale = 0.01 * percent;
  ImGui::EndDisabled();
  if (ImGui::BeginCombo("present mode", facts.present_mode.c_str())) {
    for (const std::string& mode : facts.present_modes)
      if (ImGui::Selectable(mode.c_str(), mode == facts.present_mode)) wishes.present_mode = mode;
    ImGui::EndCombo();
  }
}

void Panels::settings(const RunningScene& running, const Scene& pending, const PanelFacts& facts,
                      ViewState& view, PanelWishes& wishes) {
  const float scale = ui_scale();
  ImGui::SetNextWindowPos({0.0f, 0.0f});
  const float numbers = view.overlay ? overlay_height_ : 0.0f;
  ImGui::SetNextWindowSize({kWidth * scale, std::max(200.0f, ImGui::GetIO().DisplaySize.y - numbers)});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0f);
  ImGui::PushStyleColor(ImGuiCol_WindowBg, {0.085f, 0.095f, 0.115f, 1.0f});
  ImGui::Begin("settings", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoBringToFrontOnFocus);
  ImGui::PushItemWidth(150.0f * scale);
  Scene edited = pending;
  bool changed = false;
  scene_buttons(running, facts, wishes);
  ImGui::Separator();
  time_controls(running, wishes);
  ImGui::Separator();
  quick_sliders(edited, changed, facts, wishes);
  changed |= substeps_slider(edited, running.simulation().plan().substeps);
  stand_in_switch(running, wishes);
  kernel_choice(running, facts, wishes);
  if (ImGui::CollapsingHeader("All parameters")) all_parameters(edited, changed, facts, wishes);
  if (ImGui::CollapsingHeader("Picture", ImGuiTreeNodeFlags_DefaultOpen))
    picture_controls(facts, view, wishes);
  ImGui::Separator();
  if (ImGui::Button(view.accuracy ? "Hide what accuracy costs" : "What accuracy costs", {-1.0f, 0.0f}))
    view.accuracy = !view.accuracy;
  tooltip("F4: error against time of every solver on this device, and choosing by either");
  ImGui::TextDisabled("F1 help   Tab hides this panel");
  ImGui::PopItemWidth();
  ImGui::End();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar();
  if (changed) wishes.scene = std::move(edited);
}

PanelWishes Panels::draw(const RunningScene& running, const Scene& pending, const PanelFacts& facts,
                         ViewState& view) {
  PanelWishes wishes;
  wishes.edit_ended = ImGui::IsMouseReleased(ImGuiMouseButton_Left);
  draw_marks(running, view);
  if (view.panels) settings(running, pending, facts, view, wishes);
  if (view.overlay) overlay_height_ = draw_overlay(running, facts, view);
  if (view.timings) draw_pass_timings(running, view);
  if (view.help) draw_help(view);
  draw_divergence(running, view, wishes);
  draw_message(view);
  return wishes;
}

}  // namespace weft
