// Which passes are an effect's own follows from the plans with and without it; no list of names is kept.
#include "viewer/effect_costs.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "plan/plan.h"
#include "scene/effects.h"

namespace weft {
namespace {

std::set<std::string> pass_names(const Scene& scene) {
  std::set<std::string> names;
  const Plan plan = compile_plan(build_model(scene), find_solver(scene.solver.name), scene.solver.precision);
  for (const PlanStep& step : plan.steps) names.emplace(step.pass->name);
  return names;
}

std::string text_of(double ms) { return fmt::format("{:.{}f} ms", ms, ms < 10.0 ? 2 : 1); }

}  // namespace

std::vector<std::string> passes_of_effect(const Scene& scene, std::string_view effect) {
  Scene small = scene;  // passes do not depend on the size; pins might hold nothing of a small cloth
  small.cloth.resolution = 8;
  small.pins.clear();
  const std::set<std::string> with = pass_names(small), without = pass_names(without_effect(small, effect));
  std::vector<std::string> own;
  std::ranges::set_difference(with, without, std::back_inserter(own));
  return own;
}

void EffectCosts::follow(RunningScene& running) {
  if (running.shown_version() != shown_version_) {
    shown_version_ = running.shown_version();
    sort_passes(running.scene());
  }
  if (running.version() != version_) {
    version_ = running.version();
    found_.clear();
    trial_.reset();
    pass_ms_.clear();
  }
  const std::vector<double> ms = running.simulation().step_ms();
  const Plan& plan = running.simulation().plan();
  std::map<std::string, double, std::less<>> frame;
  for (std::size_t step = 0; step < std::min(ms.size(), plan.steps.size()); ++step)
    frame[std::string(plan.steps[step].pass->name)] += ms[step];
  for (const auto& [name, taken] : frame) {
    const auto [at, is_new] = pass_ms_.try_emplace(name, taken);
    if (!is_new) at->second += 0.1 * (taken - at->second);
  }
  if (!trial_) return;
  std::unique_ptr<EffectTrial> trial = std::move(trial_);  // one that throws is not gone on with
  const bool more = trial->go_on();
  found_ = trial->costs();
  if (more) trial_ = std::move(trial);
}

/// Asks the plans only when other effects or another solver run: a slider that moves changes neither.
void EffectCosts::sort_passes(const Scene& scene) {
  std::vector<std::string> kinds = removable_effects(scene);
  kinds.push_back(scene.solver.name + " " + scene.solver.precision);
  if (kinds == kinds_) return;
  own_passes_.clear();
  for (const std::string& effect : removable_effects(scene))
    own_passes_[effect] = passes_of_effect(scene, effect);
  own_passes_["normals"] = {"normals"};
  kinds_ = std::move(kinds);
}

void EffectCosts::start_trial(RunningScene& running) {
  const auto pipelines = std::make_shared<GpuPipelines>(device_);
  trial_ = std::make_unique<EffectTrial>(running.simulation(), [&running, pipelines](const Model& model) {
    return running.copy_of(model, pipelines);
  });
}

std::string EffectCosts::text(std::string_view effect) const {
  const auto own = own_passes_.find(effect);
  if (own != own_passes_.end() && !own->second.empty()) {
    double sum_ms = 0.0;
    for (const std::string& pass : own->second)
      if (const auto at = pass_ms_.find(pass); at != pass_ms_.end()) sum_ms += at->second;
    return sum_ms > 0.0 ? text_of(sum_ms) : "";
  }
  const auto found = found_.find(effect);
  if (found == found_.end()) return "";
  const EffectCost& cost = found->second;
  return (cost.ms < cost.doubt_ms ? "< " + text_of(cost.doubt_ms) : text_of(cost.ms)) + " (trial)";
}

}  // namespace weft
