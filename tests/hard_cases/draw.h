// Drawing scenes at random with RapidCheck: numbers from the parameter table's ranges, and frames whose work
// is capped.
#pragma once
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <string>

#include "scene/parameters.h"
#include "solvers/solver.h"

namespace weft::hard {

inline constexpr std::uint32_t kSubstepsMost = 100;  ///< of a frame

/// Whether a property holds `count` times, or as often as the variable `wish` says. RapidCheck prints what
/// repeats a failure; RC_PARAMS="seed=…" draws others.
template <class Property>
bool holds(const std::string& name, int count, const char* wish, Property&& property) {
  using namespace rc::detail;
  TestParams params = configuration().testParams;
  const char* wished = std::getenv(wish);
  params.maxSuccess = wished != nullptr ? std::stoi(wished) : count;
  if (std::getenv("RC_PARAMS") == nullptr) params.seed = 20261122;
  const auto result = checkTestable(std::forward<Property>(property), TestMetadata{name, name}, params);
  printResultMessage(result, std::cerr);
  std::cerr << '\n';
  return result.template is<SuccessResult>();
}

/// From low to high, both included; RapidCheck's own ranges begin small and grow with the test.
inline int whole(int low, int high) {
  return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(low, high + 1));
}

inline double uniform(double low, double high) {
  constexpr int kSteps = 1'000'000;
  return low + (high - low) * whole(0, kSteps) / kSteps;
}

inline double log_uniform(double low, double high) { return low * std::pow(high / low, uniform(0.0, 1.0)); }

inline bool chance(double share) { return uniform(0.0, 1.0) > 1.0 - share; }

/// A number from a parameter's whole range: over nine decades where the range begins at 0, and on both sides
/// of it where it has two.
inline double number(const Parameter& parameter) {
  const double most = parameter.maximum;
  if (parameter.minimum > 0.0) return log_uniform(parameter.minimum, most);
  if (chance(0.15)) return 0.0;
  const double size = log_uniform(1e-9 * most, most);
  return parameter.minimum < 0.0 && chance(0.5) ? -size : size;
}

/// The frame that is asked for, or as much of it as `kSubstepsMost` substeps make.
struct Step {
  double frame_s;
  std::uint32_t substeps;
};
inline Step step_of(Model& model) {
  const double substep_s = 0.9 * find_solver("leapfrog").step_max_s(model.bound);
  const double frame_s = std::min(model.scene.solver.frame_s, kSubstepsMost * substep_s);
  model.scene.solver.substeps =
      static_cast<std::uint32_t>(std::max(1.0, std::ceil(frame_s / substep_s - 1e-9)));
  return {frame_s, model.scene.solver.substeps};
}

}  // namespace weft::hard
