// The plan on paper: a table for people, JSON for programs and goldens.
#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "core/text.h"
#include "passes/collision.h"
#include "passes/reach.h"
#include "plan/buffers.h"
#include "plan/plan.h"
#include "plan/spread_frame.h"

namespace weft {
namespace {

std::string_view block_name(Block block) {
  switch (block) {
    case Block::frame_start: return "frame start";
    case Block::substep: return "substep";
    case Block::frame_end: return "frame end";
  }
  return "";
}

std::string byte_text(std::uint64_t bytes) {
  if (bytes < 1024) return fmt::format("{} B", bytes);
  if (bytes < 1024 * 1024) return fmt::format("{:.1f} KiB", static_cast<double>(bytes) / 1024);
  return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / (1024 * 1024));
}

std::string constants_text(const Constants& constants) {
  std::string text;
  for (const Constant& constant : constants)
    if (constant.value != 0) text += fmt::format("{}{}", text.empty() ? "" : " ", constant.name);
  return text.empty() ? "-" : text;
}

std::string buffer_note(BufferId id, const Plan& plan) {
  if (id != BufferId::substeps) return std::string(row_of(id).unit);
  return fmt::format("{}; {} copies of {} rows", row_of(id).unit, slot_count(id),
                     substep_row_capacity(plan.row_count()));
}

/// Says which passes do not run in every substep, a line for each interval.
std::string intervals_text(const Plan& plan) {
  std::map<std::uint32_t, std::string> names;
  for (const PlanStep& step : plan.steps)
    if (step.interval > 1) {
      std::string& text = names[step.interval];
      text += fmt::format("{}{}", text.empty() ? "" : ", ", step.pass->name);
    }
  std::string lines;
  for (const auto& [interval, passes] : names)
    lines += fmt::format("Substeps 0, {}, {}, ... alone have {}.\n", interval, 2 * interval, passes);
  return lines;
}

/// Says what of the plan a frame does not need in which the cloth stays spread out.
std::string spread_text(const Plan& plan, const Model& model) {
  constexpr std::uint32_t kInterval = 32;  // of looks, on a cloth that moves slowly
  if (!plan.spreads) return {};
  return fmt::format(
      "A frame in which the cloth stays spread out, nowhere folded, has {} dispatches: integrate, what ends "
      "a "
      "frame, and spread_look as often as it takes to know that ({} here).\n",
      spread_frame(plan, model, kInterval).dispatches(),
      counted((plan.substeps - 1) / kInterval + 2, "time"));
}

/// Says where self-collision, and not stability, decides how many substeps a frame has.
std::string raised_text(const Plan& plan, const Model& model) {
  const std::uint32_t wanted = contact_substeps(model);
  if (wanted <= 1 || model.scene.solver.substeps > 0 || plan.substeps > wanted) return {};
  return fmt::format(
      "Self-collision raises the substeps to {}: at {:.3g} m/s nothing may move by half the distance that "
      "layers keep in one.\n",
      wanted, design_speed_m_s(model));
}

}  // namespace

std::string describe(const Plan& plan, const Model& model) {
  const std::uint32_t cloths = model.grid.cloths;
  std::string text = fmt::format("{} - {}{} x {} particles, {} springs\n", model.scene.title,
                                 cloths > 1 ? fmt::format("{} cloths of ", cloths) : "", model.grid.nx,
                                 model.grid.ny, model.spring_count);
  text += fmt::format("solver {}: {} a frame of {:.6g} s, {} dispatches\n\n", plan.solver->name,
                      counted(plan.substeps, "substep"), model.scene.solver.frame_s, plan.dispatches());
  text += fmt::format("{:<12} {:<14} {:>7}  {:<12} {}\n", "block", "pass", "repeat", "range", "effects");
  for (const PlanStep& step : plan.steps)
    text +=
        fmt::format("{:<12} {:<14} {:>7}  {:<12} {}\n", block_name(step.block), step.pass->name, step.repeat,
                    fmt::format("{} x {}", step.range.x, step.range.y), constants_text(step.constants));
  text += intervals_text(plan);
  if (plan.reaching.bodies)
    text += "Contact with bodies runs in the substeps in which the cloth comes near one.\n";
  if (plan.reaching.links)
    text += fmt::format("{} runs in the substeps in which a link comes near the limit.\n",
                        plan.reaching.tears ? "tear" : "strain_limit");
  if (plan.reaching.tears)
    text += "integrate moves the cloth until a link breaks, integrate_torn from then on.\n";
  text += spread_text(plan, model);
  text += raised_text(plan, model);
  if (!plan.solver->on_gpu)
    text += fmt::format("The solver {} runs on the CPU reference only: no pipelines, no buffers.\n",
                        plan.solver->name);
  text += fmt::format("\n{:<16} {:>12}  {}\n", "buffer", "bytes", "holds");
  for (const PlanBuffer& buffer : plan.buffers)
    text += fmt::format("{:<16} {:>12}  {}\n", row_of(buffer.id).name, buffer.bytes,
                        buffer_note(buffer.id, plan));
  text += fmt::format("{:<16} {:>12}  {}\n\nleft out:\n", "total", plan.bytes(), byte_text(plan.bytes()));
  for (const LeftOut& left_out : plan.left_out)
    text += fmt::format("  {:<16} {}\n", left_out.effect, left_out.reason);
  return text;
}

std::string to_json(const Plan& plan, const Model& model) {
  using Json = nlohmann::ordered_json;
  Json json;
  json["scene"] = model.scene.title;
  json["solver"] = plan.solver->name;
  json["on_gpu"] = plan.solver->on_gpu;
  json["substeps"] = plan.substeps;
  json["dispatches"] = plan.dispatches();
  if (model.grid.cloths > 1) json["cloths"] = model.grid.cloths;
  json["steps"] = Json::array();
  for (const PlanStep& step : plan.steps) {
    Json constants = Json::object();
    for (const Constant& constant : step.constants)
      constants[std::string(constant.name)] = constant.value != 0;
    json["steps"].push_back({{"pass", step.pass->name},
                             {"block", block_name(step.block)},
                             {"repeat", step.repeat},
                             {"range", {step.range.x, step.range.y}},
                             {"constants", constants}});
    if (step.interval > 1) json["steps"].back()["interval"] = step.interval;
  }
  if (plan.spreads) json["spread_frames"] = true;
  json["buffers"] = Json::array();
  for (const PlanBuffer& buffer : plan.buffers)
    json["buffers"].push_back({{"name", row_of(buffer.id).name}, {"bytes", buffer.bytes}});
  json["left_out"] = Json::array();
  for (const LeftOut& left_out : plan.left_out)
    json["left_out"].push_back({{"effect", left_out.effect}, {"reason", left_out.reason}});
  json["bytes"] = plan.bytes();
  return json.dump(2);
}

}  // namespace weft
