// From back to front: paper, floors, grid, front, real time, lines, markers, the moving dot.
#include "viewer/diagram_drawing.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "viewer/diagram_layout.h"
#include "viewer/parameter_widgets.h"
#include "viewer/setting_choice.h"

namespace weft {
namespace {

constexpr ImU32 kPaper = IM_COL32(250, 250, 247, 255), kInk = IM_COL32(30, 30, 30, 255);
constexpr ImU32 kGridMajor = IM_COL32(200, 200, 200, 255), kGridMinor = IM_COL32(228, 228, 228, 255);
constexpr ImU32 kFrontColor = IM_COL32(240, 228, 66, 205), kRealTime = IM_COL32(176, 0, 32, 255);
constexpr float kMarkerRadius = 4.2f;

ImU32 color_of(std::string_view solver, int alpha = 255) {
  const unsigned long rgb = std::stoul(study::solver_color(solver).substr(1), nullptr, 16);
  return IM_COL32((rgb >> 16) & 255, (rgb >> 8) & 255, rgb & 255, alpha);
}

ImVec2 vec(const PlotPlace& place) { return {place.x, place.y}; }

void words(ImDrawList& list, float x, float y, ImU32 color, const std::string& text, float align = 0.0f) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  list.AddText({std::round(x - align * size.x), std::round(y - 0.5f * size.y)}, color, text.c_str());
}

/// Words on a paper-coloured ground, so that no line runs through them.
void note(ImDrawList& list, float x, float y, ImU32 color, const std::string& text, float align) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const float left = x - align * size.x;
  list.AddRectFilled({left - 2.0f, y - 0.45f * size.y}, {left + size.x + 2.0f, y + 0.45f * size.y},
                     IM_COL32(250, 250, 247, 200));
  words(list, x, y, color, text, align);
}

void marker(ImDrawList& list, std::string_view solver, ImVec2 at, bool hollow, float scale = 1.0f) {
  const study::Marker shape = study::solver_marker(solver);
  const float radius = scale * kMarkerRadius * ui_scale();
  const ImU32 color = color_of(solver), fill = hollow ? kPaper : color, edge = hollow ? color : kPaper;
  if (shape.sides == 0) {
    list.AddCircleFilled(at, radius, fill, 20);
    list.AddCircle(at, radius, edge, 20, 1.2f);
    return;
  }
  std::array<ImVec2, 8> corners{};
  for (int s = 0; s < shape.sides; ++s) {
    const double angle = shape.turn_rad + 2.0 * std::numbers::pi * s / shape.sides;
    const auto far = static_cast<float>(shape.radius) * radius;
    corners[static_cast<std::size_t>(s)] = {at.x + far * static_cast<float>(std::sin(angle)),
                                            at.y - far * static_cast<float>(std::cos(angle))};
  }
  list.AddConvexPolyFilled(corners.data(), shape.sides, fill);
  list.AddPolyline(corners.data(), shape.sides, edge, ImDrawFlags_Closed, 1.2f);
}

void cross(ImDrawList& list, ImVec2 at, ImU32 color) {
  const float r = 4.0f * ui_scale();
  list.AddLine({at.x - r, at.y - r}, {at.x + r, at.y + r}, color, 1.8f);
  list.AddLine({at.x - r, at.y + r}, {at.x + r, at.y - r}, color, 1.8f);
}

/// A line in the precision's strokes: whole, dashed for f32k, dotted for f64.
void stroke(ImDrawList& list, ImVec2 from, ImVec2 to, ImU32 color, std::string_view precision) {
  if (precision == "f32") return list.AddLine(from, to, color, 1.8f);
  const float on = precision == "f64" ? 2.0f : 7.0f, off = 4.0f;
  const float length = std::hypot(to.x - from.x, to.y - from.y);
  for (float at = 0.0f; at < length; at += on + off) {
    const float a = at / length, b = std::min(at + on, length) / length;
    list.AddLine({from.x + a * (to.x - from.x), from.y + a * (to.y - from.y)},
                 {from.x + b * (to.x - from.x), from.y + b * (to.y - from.y)}, color, 1.8f);
  }
}

void draw_axes(ImDrawList& list, const DiagramLayout& layout) {
  const PlotBox& box = layout.box();
  const float s = ui_scale();
  for (const study::Tick& tick : layout.x_ticks()) {
    const float x = layout.x_at(tick.value);
    list.AddLine({x, box.top}, {x, box.bottom}, tick.major ? kGridMajor : kGridMinor);
    if (tick.major) words(list, x, box.bottom + 9.0f * s, kInk, tick.label, 0.5f);
  }
  for (const study::Tick& tick : layout.y_ticks()) {
    const float y = layout.y_at(tick.value);
    list.AddLine({box.left, y}, {box.right, y}, tick.major ? kGridMajor : kGridMinor);
    if (tick.major) words(list, box.left - 5.0f * s, y, kInk, tick.label, 1.0f);
  }
  const float top = box.top + DiagramLayout::kMargin;
  list.AddLine({box.left, top}, {box.right, top}, IM_COL32(136, 136, 136, 255));
  words(list, box.left - 5.0f * s, box.top + 0.5f * DiagramLayout::kMargin, kInk, "diverged", 1.0f);
  words(list, 0.5f * (box.left + box.right), box.bottom + 26.0f * s, kInk,
        "device time [ms per simulated second]", 0.5f);
}

/// A band from the foot up to an error that something else already makes; `text` in a second round.
void draw_floor(ImDrawList& list, const DiagramLayout& layout, double error_m, ImU32 rgb, const char* text,
                bool on_the_right, bool only_text) {
  if (!(error_m > 0.0) || !std::isfinite(error_m)) return;
  const PlotBox& box = layout.box();
  const float y = std::min(layout.y_at(error_m), box.bottom);
  if (!only_text) {
    const ImU32 faint = (rgb & ~IM_COL32_A_MASK) | (36u << IM_COL32_A_SHIFT);
    list.AddRectFilled({box.left, y}, {box.right, box.bottom}, faint);
    stroke(list, {box.left, y}, {box.right, y}, rgb, "f32k");
    return;
  }
  if (y >= box.bottom - 1.0f) return;
  note(list, on_the_right ? box.right - 4.0f : box.left + 4.0f,
       std::min(y + 8.0f * ui_scale(), box.bottom - 7.0f * ui_scale()), rgb, text,
       on_the_right ? 1.0f : 0.0f);
}

void draw_floors(ImDrawList& list, const DiagramLayout& layout, const study::Cloth& cloth, bool only_text) {
  draw_floor(list, layout, cloth.twin_m, IM_COL32(85, 85, 85, 255), "twins drift this far apart", true,
             only_text);
  draw_floor(list, layout, cloth.float_floor_m, IM_COL32(138, 75, 8, 255), "float32 floor", false, only_text);
  draw_floor(list, layout, cloth.agreement_m, IM_COL32(122, 0, 25, 255), "the reference is known to this",
             true, only_text);
}

void draw_front(ImDrawList& list, const DiagramLayout& layout) {
  const std::vector<PlotPlace>& front = layout.front();
  for (std::size_t k = 1; k < front.size(); ++k)
    list.AddLine(vec(front[k - 1]), vec(front[k]), kFrontColor, 9.0f * ui_scale());
}

void draw_lines(ImDrawList& list, const DiagramLayout& layout) {
  for (const PlotLine& line : layout.lines()) {
    const PlotMark* before = nullptr;
    for (const PlotMark& mark : line.marks) {
      if (mark.point.diverged) continue;
      if (before != nullptr)
        stroke(list, vec(before->place), vec(mark.place), color_of(line.solver), line.precision);
      before = &mark;
    }
  }
  for (const PlotLine& line : layout.lines())
    for (const PlotMark& mark : line.marks) {
      if (mark.point.diverged)
        cross(list, vec(mark.place), color_of(line.solver));
      else
        marker(list, line.solver, vec(mark.place), line.precision == "f64");
    }
}

/// The running setting: a ring, or, where the study knows no error of it, a line at its time.
void draw_dot(ImDrawList& list, const DiagramLayout& layout, const LiveDot& live) {
  if (!live.ms_per_s) return;
  const PlotBox& box = layout.box();
  const float x = layout.x_at(*live.ms_per_s), s = ui_scale();
  stroke(list, {x, box.top}, {x, box.bottom}, IM_COL32(0, 0, 0, 120), "f64");
  if (!live.error_m) return;
  const float y = layout.y_at(*live.error_m);
  list.AddCircleFilled({x, y}, 6.5f * s, IM_COL32(255, 255, 255, 255), 24);
  list.AddCircleFilled({x, y}, 4.5f * s, IM_COL32(220, 20, 60, 255), 24);
  list.AddCircle({x, y}, 6.5f * s, IM_COL32(0, 0, 0, 255), 24, 1.6f);
}

void draw_real_time(ImDrawList& list, const DiagramLayout& layout) {
  if (!layout.shows_real_time()) return;
  const float x = layout.x_at(DiagramLayout::kRealTime_ms_per_s);
  list.AddLine({x, layout.box().top}, {x, layout.box().bottom}, kRealTime, 1.6f);
  const bool near_the_left = x - layout.box().left < 70.0f * ui_scale();
  const float y = layout.box().top + DiagramLayout::kMargin + 9.0f * ui_scale();
  note(list, near_the_left ? x + 5.0f : x - 5.0f, y, kRealTime, "real time", near_the_left ? 0.0f : 1.0f);
}

/// Solvers with their colour and marker, in as many columns as fit; then the strokes of the precisions.
void draw_legend(ImDrawList& list, const DiagramLayout& layout, float width) {
  const float s = ui_scale(), column = 132.0f * s, height = 17.0f * s;
  const int columns = std::max(1, static_cast<int>(width / column));
  const ImVec2 start = ImGui::GetCursorScreenPos();
  const ImU32 ink = ImGui::GetColorU32(ImGuiCol_Text);
  int place = 0;
  const auto next = [&] {
    const ImVec2 at{start.x + static_cast<float>(place % columns) * column,
                    start.y + static_cast<float>(place / columns) * height};
    ++place;
    return ImVec2{at.x + 12.0f * s, at.y + 0.5f * height};
  };
  std::set<std::string> solvers, precisions;
  for (const PlotLine& line : layout.lines()) {
    precisions.insert(line.precision);
    if (!solvers.insert(line.solver).second) continue;
    const ImVec2 at = next();
    list.AddCircleFilled(at, 7.5f * s, kPaper, 20);
    marker(list, line.solver, at, false);
    words(list, at.x + 12.0f * s, at.y, ink, line.solver);
  }
  for (const std::string& precision : precisions) {
    const ImVec2 at = next();
    stroke(list, {at.x - 11.0f * s, at.y}, {at.x + 11.0f * s, at.y}, ink, precision);
    words(list, at.x + 16.0f * s, at.y, ink, precision + (precision == "f64" ? ", hollow" : ""));
  }
  const ImVec2 front = next();
  list.AddLine({front.x - 10.0f * s, front.y}, {front.x + 10.0f * s, front.y}, kFrontColor, 8.0f * s);
  words(list, front.x + 16.0f * s, front.y, ink, "nothing beats it");
  const ImVec2 dot = next();
  list.AddCircleFilled(dot, 6.0f * s, IM_COL32(255, 255, 255, 255), 24);
  list.AddCircleFilled(dot, 4.0f * s, IM_COL32(220, 20, 60, 255), 24);
  words(list, dot.x + 12.0f * s, dot.y, ink, "runs now");
  ImGui::Dummy({width, height * static_cast<float>((place + columns - 1) / columns)});
}

}  // namespace

std::string point_text(const study::Point& point, double frame_s) {
  const std::string cost =
      fmt::format("{:.3g} ms a frame, {:.4g} ms per simulated second{}", study::ms_per_frame(point, frame_s),
                  point.ms_per_s, point.wall_clock ? " (wall time)" : "");
  if (point.diverged) return setting_text(point.setting) + " a frame\ndiverged\n" + cost;
  return fmt::format("{} a frame\nerror {:.2e} m\n{}\nlargest stretch {:.1f} %", setting_text(point.setting),
                     point.error_m, cost, 100.0 * point.max_stretch);
}

std::optional<study::Setting> draw_diagram(const study::Study& study, std::uint32_t nx, const LiveDot& live,
                                           float width, float height) {
  const float s = ui_scale();
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::InvisibleButton("diagram", {width, height});
  const bool hovered = ImGui::IsItemHovered(), clicked = ImGui::IsItemClicked();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 end{corner.x + width, corner.y + height};
  list.AddRectFilled(corner, end, kPaper, 4.0f);
  const PlotBox box{corner.x + 62.0f * s, corner.y + 22.0f * s, end.x - 10.0f * s, end.y - 38.0f * s};
  const DiagramLayout layout(study, nx, box, live.ms_per_s);
  words(list, corner.x + 6.0f * s, corner.y + 11.0f * s, kInk,
        "error: largest RMS distance to the reference [m]");
  draw_axes(list, layout);
  list.PushClipRect({box.left, box.top}, {box.right, box.bottom}, true);
  const study::Cloth& cloth = *study.cloth(nx);
  draw_floors(list, layout, cloth, false);
  draw_front(list, layout);
  draw_real_time(list, layout);
  draw_lines(list, layout);
  draw_floors(list, layout, cloth, true);
  draw_dot(list, layout, live);
  list.PopClipRect();
  list.AddRect({box.left, box.top}, {box.right, box.bottom}, kInk, 0.0f, 0, 1.2f);
  draw_legend(list, layout, width);
  if (!hovered) return {};
  const ImVec2 mouse = ImGui::GetMousePos();
  const PlotMark* under = layout.nearest({mouse.x, mouse.y}, 10.0f * s);
  if (under == nullptr) return {};
  marker(list, under->point.setting.solver, vec(under->place), under->point.setting.precision == "f64", 1.7f);
  ImGui::SetTooltip("%s\nclick to run it", point_text(under->point, study.frame_s).c_str());
  if (clicked) return under->point.setting;
  return {};
}

}  // namespace weft
