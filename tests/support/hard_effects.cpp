// Effects made hard by the parameter table: whatever has a row there is swept over its slider.
#include "support/hard_effects.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/effects.h"
#include "scene/parameters.h"
#include "support/hard_case_parts.h"

namespace weft::hard {
namespace {

constexpr double kFall_m = 0.6;

/// Whether a row of the table is a number of the effect: of its section, or of [material] with its name.
bool belongs(const Parameter& parameter, std::string_view effect) {
  const bool numeric = parameter.kind == ParameterKind::number || parameter.kind == ParameterKind::vec3;
  const bool place = parameter.kind == ParameterKind::vec3 && parameter.unit == "m";
  return numeric && !place && parameter.slider_maximum > parameter.slider_minimum &&
         (parameter.section == effect ||
          (parameter.section == "material" && parameter.key.starts_with(effect)));
}

/// Share 0 to 1 of the slider: over three decades where it begins at 0.
double on_slider(const Parameter& parameter, double share) {
  const double low = parameter.slider_minimum, high = parameter.slider_maximum;
  if (low > 0.0) return low * std::pow(high / low, share);
  if (low < 0.0) return low + (high - low) * share;
  return share < 0.05 ? 0.0 : high * std::pow(1e-3, 1.0 - share);
}

std::string case_about(std::string_view effect) {
  return fmt::format(
      "falls at 30 m/s on what there is of `{}`, every number of which goes over its slider, each frame "
      "elsewhere",
      effect);
}

}  // namespace

Scene above_effect(Scene scene, std::string_view effect) {
  scene = with_effect(std::move(scene), effect);
  scene.cloth.center_m.y += kFall_m - kEffectFar_m;
  return scene;
}

Scene with_swept_effect(Scene scene, std::string_view effect, std::uint64_t k) {
  int n = 0;
  const auto share = [&] {
    const double period = 3.7 + 1.3 * n++;
    return 0.5 + 0.5 * std::sin(2.0 * std::numbers::pi * static_cast<double>(k) / period);
  };
  for (const Parameter& parameter : parameters()) {
    if (!belongs(parameter, effect)) continue;
    for (std::size_t item = 0; item < item_count(scene, parameter.section); ++item)
      if (parameter.kind == ParameterKind::vec3)
        parameter.set(scene, item,
                      glm::dvec3(on_slider(parameter, share()), on_slider(parameter, share()),
                                 on_slider(parameter, share())));
      else
        parameter.set(scene, item, on_slider(parameter, share()));
  }
  return scene;
}

std::vector<HardCase> effect_cases() {
  std::vector<HardCase> list;
  for (const Effect& effect : effects())
    list.push_back({.name = fmt::format("effect-{}", effect.name),
                    .about = case_about(effect.name),
                    .scene = "fallen",
                    .time_s = 0.2,
                    .start = Start::falling_30,
                    .hand = Hand::sweeps_effect,
                    .effect = std::string(effect.name),
                    .solver = std::string(effect.solver)});
  return list;
}

}  // namespace weft::hard
