// Rounding: a place in float is off by half a unit, which a particle may gain in every substep.
#include "native/link_watch.h"

#include <algorithm>
#include <cmath>

#include "passes/passes.h"
#include "passes/strain_limit.h"

namespace weft::native {

bool sweep_watches_links(const Plan& plan, const Model& model) {
  return plan.reaching.links && !model.scene.self_collision && model.grid.cloths == 1 &&
         std::ranges::any_of(plan.steps, [](const PlanStep& step) { return step.pass == &integrate; });
}

LinkWatch::LinkWatch(Cloth& cloth, const Kernels& kernels, const Model& model)
    : cloth_(cloth), kernels_(kernels), rows_(cloth.padded_rows()) {
  const auto limits = strain_limit_rows<float>(model);
  structural_m_ = limits[shared::kLimitStructural].x, structural_m2_ = limits[shared::kLimitStructural].y;
  shear_m_ = limits[shared::kLimitShear].x, shear_m2_ = limits[shared::kLimitShear].y;
}

void LinkWatch::forget() {
  leap2_ = kNoLeap;
  left_ = 0;
  leapt_ = one_by_one_ = false;
}

void LinkWatch::take_back(std::uint32_t) {
  leapt_ = false;
  one_by_one_ = true;
}

LinkLook LinkWatch::look(Crew& crew, std::uint32_t threads) {
  std::vector<LinkLook> looks(threads);
  crew.run(threads, [&](std::uint32_t own) {
    looks[own] = {.stride = cloth_.sheet().stride,
                  .nx = cloth_.nx(),
                  .ny = cloth_.ny(),
                  .first = own * cloth_.ny() / threads,
                  .last = (own + 1) * cloth_.ny() / threads,
                  .rows = rows_.data()};
    kernels_.look_at_links(looks[own]);
  });
  LinkLook all = looks[0];
  for (const LinkLook& one : looks) {
    all.structural2 = std::max(all.structural2, one.structural2);
    all.shear2 = std::max(all.shear2, one.shear2);
    all.speed2 = std::max(all.speed2, one.speed2);
    all.place2 = std::max(all.place2, one.place2);
  }
  return all;
}

bool LinkWatch::is_near(const Kick& kick, Crew& crew, std::uint32_t threads) {
  if (left_ > 0 && !leapt_) {
    --left_;
    return false;
  }
  constexpr double kFaster = 1.25, kRounding = 4e-7, kLess = 0.99, kSubstepsMax = 4096.0;
  const LinkLook now = look(crew, threads);
  forget();
  if (now.structural2 > structural_m2_ || now.shear2 > shear_m2_) return true;
  const double place_m = std::sqrt(double{now.place2});
  const double room_m = kLess * std::min(structural_m_ - std::sqrt(double{now.structural2}),
                                         shear_m_ - std::sqrt(double{now.shear2}));
  const double way_m = kFaster * std::sqrt(double{now.speed2}) * kick.drift + 1e-4 * structural_m_;
  const double used_m = 2.0 * (way_m + kRounding * (place_m + structural_m_));
  const double substeps = room_m / used_m;
  if (!(substeps >= 1.0)) return false;
  left_ = static_cast<std::uint32_t>(std::min(substeps, kSubstepsMax));
  leap2_ = static_cast<float>(kLess * way_m * way_m);
  return false;
}

}  // namespace weft::native
