// The message over a scene that has diverged, with the way back.
#include <imgui.h>

#include <algorithm>

#include "viewer/panels.h"
#include "viewer/parameter_widgets.h"

namespace weft {

void draw_divergence(const RunningScene& running, const ViewState& view, PanelWishes& wishes) {
  if (!running.diverged()) return;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float left = view.panels ? Panels::kWidth * ui_scale() : 0.0f;
  const float width = std::clamp(size.x - left - 60.0f, 200.0f, 620.0f * ui_scale());
  ImGui::SetNextWindowPos({left + 0.5f * (size.x - left), 0.12f * size.y}, ImGuiCond_Always, {0.5f, 0.0f});
  ImGui::SetNextWindowSize({width, 0.0f});
  ImGui::Begin("The simulation diverged", nullptr,
               ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove);
  ImGui::TextWrapped("%s.", running.divergence_text().c_str());
  ImGui::TextWrapped("The picture shows the last good state, of t = %.4g s.", running.simulation().time_s());
  wishes.restore |= ImGui::Button("Restore the last good state");
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("goes on from it, paused: change what caused this first");
  ImGui::SameLine();
  wishes.reset |= ImGui::Button("Reset##diverged");
  ImGui::End();
}

}  // namespace weft
