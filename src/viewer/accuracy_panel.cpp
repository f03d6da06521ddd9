// The panel's rows from top to bottom.
#include "viewer/accuracy_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "viewer/diagram_drawing.h"
#include "viewer/history_plot.h"
#include "viewer/parameter_widgets.h"

namespace weft {
namespace {

const ImVec4 kWarningColor{1.0f, 0.72f, 0.30f, 1.0f};

void wrapped(const std::string& text) { ImGui::TextWrapped("%s", text.c_str()); }
void wrapped(const ImVec4& color, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  wrapped(text);
  ImGui::PopStyleColor();
}

/// Where the last widget lies.
std::array<float, 4> place_of_item(float width) {
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  return {low.x, low.y, width > 0.0f ? low.x + width : high.x, high.y};
}

void study_rows(const Accuracy& accuracy, const RunningScene& running, AccuracyWishes& wishes) {
  if (const StudyRun* run = accuracy.study_run()) {
    const StudyProgress now = run->progress();
    const float share = now.total > 0 ? static_cast<float>(now.done) / static_cast<float>(now.total) : 0.0f;
    const std::string text =
        now.total > 0 ? fmt::format("{} of {} settings, {:.0f} s", now.done, now.total, now.elapsed_s)
                      : fmt::format("the reference, {:.0f} s", now.elapsed_s);
    ImGui::ProgressBar(share, {-80.0f * ui_scale(), 0.0f}, text.c_str());
    ImGui::SameLine();
    wishes.cancel_study = ImGui::Button("Cancel", {-1.0f, 0.0f});
    wishes.study_button = place_of_item(0.0f);
    wrapped(now.doing);
    ImGui::TextDisabled("The cloth rests meanwhile, so that the times are right.");
    return;
  }
  const Grid& grid = running.model().grid;
  if (accuracy.study() == nullptr)
    wrapped(
        fmt::format("No study of this cloth at {} x {} on this device is kept. A quick one measures every "
                    "solver over the first {:g} s; it takes up to two minutes, and the cloth rests "
                    "meanwhile.",
                    grid.nx, grid.ny, Accuracy::kStudyTime_s));
  if (!accuracy.study_failure().empty()) wrapped(kWarningColor, accuracy.study_failure());
  if (accuracy.study() != nullptr) return;
  wishes.start_study = ImGui::Button("Run the quick study", {-1.0f, 0.0f});
  wishes.study_button = place_of_item(0.0f);
}

std::optional<double> live_ms_per_s(const Accuracy& accuracy) {
  const double ms = accuracy.watch().device_ms_per_s();
  return ms > 0.0 ? std::optional(ms) : std::nullopt;
}

void diagram_rows(Accuracy& accuracy, const RunningScene& running, AccuracyWishes& wishes) {
  const study::Study* study = accuracy.study();
  if (study == nullptr || study->cloth(accuracy.nx()) == nullptr) return;
  const float width = ImGui::GetContentRegionAvail().x;
  const LiveDot dot{live_ms_per_s(accuracy), accuracy.measured_error_m(), setting_text(accuracy.setting())};
  const auto clicked = draw_diagram(*study, accuracy.nx(), dot, width, 0.58f * width);
  if (clicked) {
    accuracy.wish().kind = WishKind::by_hand;
    wishes.setting = clicked;
  }
  ImGui::TextDisabled(
      "%s", fmt::format("{}{} x {}, first {:g} s, {}", study->quick ? "quick study, " : "",
                        running.model().grid.nx, running.model().grid.ny, study->time_s, study->date)
                .c_str());
}

void now_rows(const Accuracy& accuracy, const RunningScene& running) {
  const double frame_s = running.scene().solver.frame_s;
  const LiveWatch& watch = accuracy.watch();
  std::string line = setting_text(accuracy.setting());
  if (const auto ms = live_ms_per_s(accuracy))
    line += fmt::format(": {:.2f} ms a frame, {:.2f} x real time", *ms * frame_s, 1e3 / *ms);
  wrapped(line);
  if (const auto error_m = accuracy.measured_error_m())
    wrapped(fmt::format("error as studied: {:.1e} m", *error_m));
  else if (accuracy.study() != nullptr)
    ImGui::TextDisabled("the study has no error for these substeps: a line marks the time");
  if (const auto& error = watch.frame_error())
    wrapped(fmt::format("one frame against {} substeps: {:.1e} m apart (at {:.1f} s)", 2 * error->substeps,
                        error->error_m, error->time_s));
  else if (!watch.trouble().empty())
    wrapped(kWarningColor, watch.trouble());
  else
    ImGui::TextDisabled("one frame against twice the substeps: %s", running.paused() ? "paused" : "...");
}

/// What the sliders' labels leave.
float slider_width() { return ImGui::GetContentRegionAvail().x - 80.0f * ui_scale(); }

/// A slider over decades. (ImGui's own logarithmic one cuts off what its format does not show.)
bool wish_slider(const char* label, double& value, double least, double most, const std::string& shown) {
  ImGui::SetNextItemWidth(slider_width());
  auto decades = static_cast<float>(std::log10(value));
  const bool moved =
      ImGui::SliderFloat(label, &decades, static_cast<float>(std::log10(least)),
                         static_cast<float>(std::log10(most)), shown.c_str(), ImGuiSliderFlags_NoInput);
  if (moved) value = std::pow(10.0, decades);
  return moved;
}

void choosing_rows(Accuracy& accuracy, AccuracyWishes& wishes) {
  ImGui::BeginDisabled(accuracy.study() == nullptr);
  SettingWish& wish = accuracy.wish();
  const auto radio = [&](const char* name, WishKind kind) {
    if (ImGui::RadioButton(name, wish.kind == kind)) wish.kind = kind;
  };
  radio("by hand", WishKind::by_hand);
  ImGui::SameLine();
  radio("by error", WishKind::error);
  ImGui::SameLine();
  radio("by frame time", WishKind::budget);
  if (wish_slider("error [m]", wish.error_m, 1e-8, 1e-1, fmt::format("{:.1e}", wish.error_m)))
    wish.kind = WishKind::error;
  wishes.error_slider = place_of_item(slider_width());
  if (wish_slider("frame [ms]", wish.budget_ms, 0.05, 500.0, fmt::format("{:.3g}", wish.budget_ms)))
    wish.kind = WishKind::budget;
  ImGui::EndDisabled();
  const SettingChoice& choice = accuracy.choice();
  if (accuracy.study() == nullptr)
    ImGui::TextDisabled("choosing needs a study");
  else if (choice.line.empty())
    ImGui::TextDisabled("the sliders choose solver, precision and substeps");
  else if (choice.point)
    wrapped(choice.line);
  else
    wrapped(kWarningColor, choice.line);
}

void cost_rows(const Accuracy& accuracy) {
  const LiveWatch& watch = accuracy.watch();
  std::string line = fmt::format("This panel takes {:.1f} ms of each second", watch.cost_ms_per_s());
  if (const auto& error = watch.frame_error())
    line += fmt::format(", the frame computed again {:.0f} ms of that each time", error->cost_ms);
  line += fmt::format("; {:.1f} MiB for its copy of the cloth. Closed it takes nothing.",
                      static_cast<double>(watch.bytes()) / (1 << 20));
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
  wrapped(line);
  ImGui::PopStyleColor();
}

}  // namespace

AccuracyWishes draw_accuracy_panel(const RunningScene& running, Accuracy& accuracy) {
  AccuracyWishes wishes;
  const float scale = ui_scale();
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float width = std::min(kAccuracyWidth * scale, size.x);
  ImGui::SetNextWindowPos({size.x - width, 0.0f});
  ImGui::SetNextWindowSize({width, size.y});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0f);
  ImGui::PushStyleColor(ImGuiCol_WindowBg, {0.085f, 0.095f, 0.115f, 1.0f});
  bool open = true;
  ImGui::Begin("Accuracy against time", &open,
               ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoFocusOnAppearing);
  wishes.close = !open;
  study_rows(accuracy, running, wishes);
  diagram_rows(accuracy, running, wishes);
  now_rows(accuracy, running);
  ImGui::Separator();
  choosing_rows(accuracy, wishes);
  ImGui::Separator();
  draw_history(accuracy.watch().history(), ImGui::GetContentRegionAvail().x);
  ImGui::Separator();
  cost_rows(accuracy);
  ImGui::End();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar();
  return wishes;
}

}  // namespace weft
