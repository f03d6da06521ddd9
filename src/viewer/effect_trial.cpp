// Both copies run the same frames in turn, so that what else the machine does meets both; the quickest frame
// of each counts, since everything else only adds.
#include "viewer/effect_trial.h"

#include <algorithm>
#include <numeric>

#include "scene/effects.h"
#include "solvers/solver.h"

namespace weft {
namespace {

constexpr std::size_t kRounds = 8;    // the first warms up
constexpr double kDoubtShare = 0.02;  // of a frame: what two equal runs differ by on a quiet machine

double quickest(const std::vector<double>& frames_ms) {
  return *std::min_element(frames_ms.begin() + 1, frames_ms.end());
}

}  // namespace

std::vector<std::string> removable_effects(const Scene& scene) {
  std::vector<std::string> names = effects_of(scene);
  std::erase(names, "pins");
  return names;
}

EffectTrial::EffectTrial(DrawnSimulation& running, CopyMaker make_copy)
    : make_copy_(std::move(make_copy)),
      scene_(running.model().scene),
      state_(running.read()),
      effects_(removable_effects(running.model().scene)) {
  scene_.solver.substeps = running.plan().substeps;
}

EffectTrial::Copy EffectTrial::copy_of(const Scene& scene) const {
  Copy copy;
  copy.simulation = make_copy_(build_model(scene));
  copy.simulation->write(state_);
  return copy;
}

/// Returns whether the copy's frame is unfinished.
bool EffectTrial::frame_part(Copy& copy) {
  DrawnSimulation& simulation = *copy.simulation;
  if (!copy.under_way) simulation.begin_frame(scene_.solver.frame_s, scene_.solver.substeps);
  copy.under_way = simulation.continue_frame();
  simulation.wait();
  if (copy.under_way) return true;
  const std::vector<double> steps = simulation.step_ms();
  copy.frames_ms.push_back(std::accumulate(steps.begin(), steps.end(), 0.0));
  return false;
}

bool EffectTrial::go_on() {
  if (next_ >= effects_.size()) return false;
  if (!with_) with_ = copy_of(scene_);
  if (!without_) {
    without_ = copy_of(without_effect(scene_, effects_[next_]));
    return true;
  }
  Copy& turn = with_->frames_ms.size() <= without_->frames_ms.size() ? *with_ : *without_;
  if (frame_part(turn) || without_->frames_ms.size() < kRounds) return true;
  settle();
  return next_ < effects_.size();
}

void EffectTrial::settle() {
  const double with_ms = quickest(with_->frames_ms), without_ms = quickest(without_->frames_ms);
  costs_[effects_[next_]] = {std::max(with_ms - without_ms, 0.0), kDoubtShare * with_ms};
  without_.reset();
  with_->frames_ms.clear();
  if (++next_ == effects_.size()) with_.reset();
}

}  // namespace weft
