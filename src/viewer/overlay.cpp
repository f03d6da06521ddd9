// Panels that only show: numbers in the corner, milliseconds a pass, help, messages, marks in the scene.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "viewer/keys.h"
#include "viewer/panels.h"
#include "viewer/parameter_widgets.h"

namespace weft {
namespace {

constexpr ImGuiWindowFlags kNote = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav |
                                   ImGuiWindowFlags_NoInputs;
const ImVec4 kWarning{1.0f, 0.72f, 0.30f, 1.0f};
const ImVec4 kBad{1.0f, 0.45f, 0.40f, 1.0f};

void line(const std::string& text) { ImGui::TextUnformatted(text.c_str()); }
void line(const ImVec4& color, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  line(text);
  ImGui::PopStyleColor();
}

void device_lines(const RunningScene& running, const PanelFacts& facts) {
  const bool native = running.on_gpu() == nullptr;
  if (native) line(running.computed_by());
  line(native ? "drawn by " + facts.device : facts.device);
  if (!running.why_not_native().empty()) line(kWarning, "the reference runs: " + running.why_not_native());
  if (facts.software) line(kWarning, native ? "no GPU is used" : "software device: no GPU is used");
}

/// Milliseconds, or seconds where those would not fit the panel's width.
std::string duration_text(double ms) {
  return ms < 1e4 ? fmt::format("{:.1f} ms", ms) : fmt::format("{:.0f} s", 1e-3 * ms);
}

/// Until a frame is done, what to expect of it.
std::string frame_text(const RunFigures& figures) {
  if (figures.frame_ms > 0.0) return duration_text(figures.frame_ms);
  return figures.expected_ms > 0.0 ? "about " + duration_text(figures.expected_ms) : "...";
}

/// Which of the two keeps the scene from its pace.
std::string why_slow(const RunningScene& running, const PanelFacts& facts) {
  const RunFigures& figures = running.figures();
  const double allowed_ms = running.allowed_ms();
  const double needed_ms = figures.frame_ms > 0.0 ? figures.frame_ms : figures.expected_ms;
  if (needed_ms > allowed_ms || facts.draw_ms <= 0.0)
    return fmt::format("slow motion: {} for a frame of {:.1f} ms", frame_text(figures), allowed_ms);
  return fmt::format("slow motion: a picture takes {:.0f} ms", facts.draw_ms);
}

void pace_lines(const RunningScene& running, const PanelFacts& facts) {
  const Pacer& pacer = running.pacer();
  if (running.diverged()) {
    line(kBad, "diverged: stopped at the last good state");
  } else if (running.paused()) {
    line(kWarning, fmt::format("paused at {:.2f} s", running.simulation().time_s()));
  } else {
    line(fmt::format("{:.2f} s, {} x real time", running.simulation().time_s(),
                     factor_text(pacer.real_time_factor())));
    if (running.stand_in().active()) line(kWarning, running.stand_in().text(running.figures().max_stretch));
    if (!pacer.slow_motion()) return;
    line(kWarning, slow_motion_text(running.pace()));
    line(kWarning, why_slow(running, facts));
  }
}

}  // namespace

float draw_overlay(const RunningScene& running, const PanelFacts& facts, const ViewState& view) {
  // Below the sliders, where no cloth is; in a corner when the panel is hidden.
  const float scale = ui_scale();
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  if (view.panels) {
    ImGui::SetNextWindowPos({0.0f, display.y}, ImGuiCond_Always, {0.0f, 1.0f});
    ImGui::SetNextWindowSizeConstraints({Panels::kWidth * scale, 0.0f}, {Panels::kWidth * scale, display.y});
    ImGui::PushStyleColor(ImGuiCol_WindowBg, {0.06f, 0.07f, 0.085f, 1.0f});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0f);
  } else {
    ImGui::SetNextWindowPos({10.0f, 10.0f}, ImGuiCond_Always);
    ImGui::PushStyleColor(ImGuiCol_WindowBg, {0.06f, 0.07f, 0.085f, 0.62f});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6.0f);
  }
  ImGui::Begin("numbers", nullptr, kNote);
  const float right = Panels::kWidth * scale - ImGui::GetStyle().WindowPadding.x;
  if (view.panels) ImGui::PushTextWrapPos(right);  // a line that is cut off would hide what it warns of
  const Grid& grid = running.model().grid;
  const RunFigures& figures = running.figures();
  device_lines(running, facts);
  pace_lines(running, facts);
  line(fmt::format("{}{} x {} = {} particles", grid.cloths > 1 ? fmt::format("{} x ", grid.cloths) : "",
                   grid.nx, grid.ny, grid.count()));
  line(fmt::format("{} substeps a frame", running.simulation().plan().substeps));
  const std::string share = share_of_time_text(figures.frame_ms, running.allowed_ms());
  line(fmt::format("simulation {} a frame{}{}", frame_text(figures), share.empty() ? "" : ", ", share));
  line(fmt::format("drawing {:.1f} ms, {:.0f} pictures/s", facts.draw_ms, facts.pictures_per_s));
  if (!facts.share.empty()) line(kWarning, facts.share);
  if (view.look.stride > 1) line(fmt::format("drawn with 1 of {0} x {0} particles", view.look.stride));
  if (facts.scale < 0.999 && facts.share.empty())
    line(fmt::format("drawn at {:.0f} % of the size", 100.0 * facts.scale));
  if (figures.measured_at_s >= 0.0)
    line(fmt::format("largest stretch {:.1f} %", 100.0 * figures.max_stretch));
  if (facts.validating)
    line(facts.validation_messages > 0 ? kBad : ImGui::GetStyleColorVec4(ImGuiCol_Text),
         fmt::format("validation: {} messages", facts.validation_messages));
  if (view.panels) ImGui::PopTextWrapPos();
  const float height = ImGui::GetWindowHeight();
  ImGui::End();
  ImGui::PopStyleVar();
  ImGui::PopStyleColor();
  return height;
}

void draw_pass_timings(const RunningScene& running, const ViewState&) {
  ImGui::SetNextWindowPos({ImGui::GetIO().DisplaySize.x - 10.0f, ImGui::GetIO().DisplaySize.y - 10.0f},
                          ImGuiCond_Always, {1.0f, 1.0f});
  ImGui::SetNextWindowBgAlpha(0.75f);
  ImGui::Begin("pass timings", nullptr, kNote);
  const Plan& plan = running.simulation().plan();
  const std::vector<double> ms = running.simulation().step_ms();
  line("milliseconds a frame, by pass");
  ImGui::Separator();
  double sum_ms = 0.0;
  if (ImGui::BeginTable("passes", 3, ImGuiTableFlags_SizingFixedFit)) {
    for (std::size_t k = 0; k < plan.steps.size(); ++k) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      line(std::string(plan.steps[k].pass->name));
      ImGui::TableNextColumn();
      line(fmt::format("x {}", plan.steps[k].repeat));
      ImGui::TableNextColumn();
      if (k < ms.size()) {
        line(fmt::format("{:9.3f}", ms[k]));
        sum_ms += ms[k];
      }
    }
    ImGui::EndTable();
  }
  line(ms.empty() ? "this device has no timestamps" : fmt::format("sum {:.3f} ms", sum_ms));
  ImGui::End();
}

void draw_help(ViewState& view) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float left = view.panels ? Panels::kWidth * ui_scale() : 0.0f;
  ImGui::SetNextWindowPos({left + 0.5f * (size.x - left), 0.5f * size.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowBgAlpha(0.94f);
  ImGui::Begin("Keys and mouse", &view.help,
               ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove);
  std::string_view group;
  if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
    for (const KeyRow& key : key_rows()) {
      if (key.keys.empty()) continue;
      if (key.group != group) {
        group = key.group;
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        line({0.55f, 0.75f, 1.0f, 1.0f}, std::string(group));
      }
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      line("  " + std::string(key.keys) + "   ");
      ImGui::TableNextColumn();
      line(std::string(key.about));
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

void draw_message(ViewState& view) {
  if (!view.message) return;
  if (!view.message->is_error && std::chrono::steady_clock::now() > view.message->until) {
    view.message.reset();
    return;
  }
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float left = view.panels ? Panels::kWidth * ui_scale() : 0.0f;
  const float width = std::max(200.0f, size.x - left - 40.0f);
  ImGui::SetNextWindowPos({left + 0.5f * (size.x - left), size.y - 14.0f}, ImGuiCond_Always, {0.5f, 1.0f});
  ImGui::SetNextWindowSizeConstraints({0.0f, 0.0f}, {width, size.y});
  ImGui::SetNextWindowBgAlpha(0.90f);
  ImGui::Begin("message", nullptr, kNote);
  const ImVec2 wanted = ImGui::CalcTextSize(view.message->text.c_str(), nullptr, false, width - 30.0f);
  ImGui::PushTextWrapPos(wanted.x + 20.0f);
  line(view.message->is_error ? kBad : ImGui::GetStyleColorVec4(ImGuiCol_Text), view.message->text);
  ImGui::PopTextWrapPos();
  if (view.message->is_error) ImGui::TextDisabled("Esc closes this");
  ImGui::End();
}

void draw_marks(const RunningScene& running, const ViewState& view) {
  const glm::mat4 clip = view.camera.clip(view.area.aspect());
  const ImVec2 pixels = ImGui::GetIO().DisplayFramebufferScale;
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  const auto mark = [&](const glm::dvec3& place_m, ImU32 color) {
    const glm::vec4 there = clip * glm::vec4(glm::vec3(place_m), 1.0f);
    if (there.w <= 0.0f) return;
    const float x = (0.5f + 0.5f * there.x / there.w) * static_cast<float>(view.area.width) +
                    static_cast<float>(view.area.x);
    const float y = (0.5f + 0.5f * there.y / there.w) * static_cast<float>(view.area.height) +
                    static_cast<float>(view.area.y);
    list->AddCircleFilled({x / pixels.x, y / pixels.y}, 5.0f, color);
    list->AddCircle({x / pixels.x, y / pixels.y}, 6.5f, IM_COL32(0, 0, 0, 160), 0, 1.5f);
  };
  for (const HandPin& pin : running.hand_pins()) mark(pin.place_m, IM_COL32(255, 190, 70, 235));
  if (running.hand().holds()) mark(running.hand().grip(), IM_COL32(120, 200, 255, 235));
}

bool draw_quit_question(ViewState& view) {
  if (!view.ask_quit) return false;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * size.x, 0.4f * size.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowFocus();
  ImGui::Begin("Quit?", nullptr,
               ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove);
  line("Quit Weft?  Enter quits, Esc stays.");
  const bool yes = ImGui::Button("Quit", {110.0f * ui_scale(), 0.0f});
  ImGui::SameLine();
  if (ImGui::Button("Stay", {110.0f * ui_scale(), 0.0f})) view.ask_quit = false;
  ImGui::End();
  return yes;
}

}  // namespace weft
