// Each picture has its own range, said below it.
#include "viewer/history_plot.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "viewer/parameter_widgets.h"

namespace weft {
namespace {

constexpr ImU32 kGround = IM_COL32(28, 32, 40, 255), kFrame = IM_COL32(80, 88, 100, 255);
constexpr ImU32 kBlue = IM_COL32(86, 180, 233, 255), kOrange = IM_COL32(230, 159, 0, 255);

struct Curve {
  std::function<double(const study::Sample&)> value;
  ImU32 color;
};

void draw_curves(const study::History& history, const char* title, const std::vector<Curve>& curves,
                 const char* unit, float width, float height) {
  const auto& samples = history.samples();
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::Dummy({width, height});
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float line = ImGui::GetTextLineHeight();
  const ImVec2 low{corner.x, corner.y + line + 2.0f}, high{corner.x + width, corner.y + height - line - 2.0f};
  list.AddText(corner, ImGui::GetColorU32(ImGuiCol_Text), title);
  list.AddRectFilled(low, high, kGround);
  list.AddRect(low, high, kFrame);
  if (samples.size() < 2) return;
  double least = 1e300, most = -1e300;
  for (const study::Sample& sample : samples)
    for (const Curve& curve : curves) {
      least = std::min(least, curve.value(sample));
      most = std::max(most, curve.value(sample));
    }
  const double span = std::max(most - least, 1e-12), from_s = samples.front().time_s,
               span_s = std::max(samples.back().time_s - from_s, 1e-9);
  for (const Curve& curve : curves) {
    std::vector<ImVec2> places;
    for (const study::Sample& sample : samples)
      places.emplace_back(
          low.x + static_cast<float>((sample.time_s - from_s) / span_s) * (high.x - low.x),
          high.y - 3.0f - static_cast<float>((curve.value(sample) - least) / span) * (high.y - low.y - 6.0f));
    list.AddPolyline(places.data(), static_cast<int>(places.size()), curve.color, 0, 1.5f);
  }
  const ImU32 dim = ImGui::GetColorU32(ImGuiCol_TextDisabled);
  const auto below = [&](float share, ImU32 color, const std::string& text) {  // of the room that is left
    const float room = high.x - low.x - ImGui::CalcTextSize(text.c_str()).x;
    list.AddText({low.x + share * room, high.y + 1.0f}, color, text.c_str());
  };
  below(0.0f, dim, fmt::format("{:.1f} s", from_s));
  below(0.5f, ImGui::GetColorU32(ImGuiCol_Text), fmt::format("{:.3g} to {:.3g} {}", least, most, unit));
  below(1.0f, dim, fmt::format("{:.1f} s", samples.back().time_s));
}

}  // namespace

void draw_history(const study::History& history, float width) {
  const float gap = ImGui::GetStyle().ItemSpacing.x, half = 0.5f * (width - gap), height = 96.0f * ui_scale();
  draw_curves(history, "stretch: largest, p99",
              {{[](const study::Sample& s) { return 100.0 * s.max_stretch; }, kBlue},
               {[](const study::Sample& s) { return 100.0 * s.p99_stretch; }, kOrange}},
              "%", half, height);
  ImGui::SameLine(0.0f, gap);
  draw_curves(history, "energy", {{[](const study::Sample& s) { return s.energy_j; }, kBlue}}, "J", half,
              height);
}

}  // namespace weft
