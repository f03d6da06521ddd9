// Rows as they are between sweeps: all of them are done, so that any row may be read.
#include "native/effects.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "native/body_touch.h"
#include "passes/passes.h"
#include "passes/reach.h"
#include "passes/strain_limit.h"
#include "shared/links.h"

namespace weft::native {
namespace {

constexpr std::array kOnRows{&pin_release, &aerodynamics, &solid_contact, &pin_place, &tear};

}  // namespace

Effects::Effects(Cloth& cloth, const Kernels& kernels, const Model& model, bool touches_bodies)
    : cloth_(cloth),
      kernels_(kernels),
      rows_(cloth.padded_rows()),
      solid_count_(solid_count(model)),
      knows_near_(asks_bodies(model)),
      ground_(model),
      held_(model.moved_particles) {
  for (const MovedParticle& held : held_)
    loosest_.push_back(static_cast<float>(model.loosest_inverse_mass(held.particle)));
  if (touches_bodies && !solid_contact.domain(model).empty()) {
    before_ = make_floats(cloth.rows() * 3 * cloth.sheet().stride);
    left_over_.resize(model.grid.count());
  }
  if (model.scene.aerodynamics) kicked_ = make_floats(cloth.rows() * 3 * cloth.sheet().stride);
  const auto limits = strain_limit_rows<float>(model);
  longest_structural_m2_ = limits[shared::kLimitStructural].y;
  longest_shear_m2_ = limits[shared::kLimitShear].y;
}

std::uint64_t Effects::bytes() const {
  const std::uint64_t vectors = (before_ ? 1u : 0u) + (kicked_ ? 1u : 0u);
  return vectors * cloth_.rows() * 3 * cloth_.sheet().stride * sizeof(float) +
         (left_over_.size() + links_before_.capacity() + loosest_.size()) * sizeof(std::uint32_t) +
         held_.size() * sizeof(MovedParticle);
}

bool Effects::has(const Pass& pass) { return std::ranges::count(kOnRows, &pass) > 0; }

bool Effects::run(const PlanStep& step, const Kick& kick, Crew& crew, std::uint32_t threads) {
  if (step.pass == &pin_release) return release_pins(kick);
  if (step.pass == &pin_place) place_pins(kick);
  if (step.pass == &solid_contact) touch_solids(kick, crew, threads);
  if (step.pass == &aerodynamics) kick_by_air(kick, crew, threads);
  if (step.pass == &weft::tear) tear_links(crew, threads);
  return false;
}

bool Effects::release_pins(const Kick& kick) {
  bool any = false;
  for (std::size_t h = 0; h < held_.size(); ++h) {
    const std::uint32_t particle = held_[h].particle;
    if (kick.pins[held_[h].pin].released == 0 || cloth_.relative_inverse_mass()[particle] != 0.0f) continue;
    if (loosest_[h] == 0.0f) continue;  // another pin holds it for good
    cloth_.set_relative_inverse_mass(particle, loosest_[h]);
    any = true;
  }
  return any;
}

void Effects::place_pins(const Kick& kick) {
  for (const MovedParticle& held : held_) {
    const PinPlace& pin = kick.pins[held.pin];
    if (pin.released != 0) continue;
    const glm::vec3 anchor(held.anchor_m);
    const float x[3] = {anchor.x + pin.offset[0], anchor.y + pin.offset[1], anchor.z + pin.offset[2]};
    cloth_.place(held.particle, x, pin.velocity);
    // The mirror makes it fixed as well: a hand may have let go of it.
    if (cloth_.relative_inverse_mass()[held.particle] != 0.0f)
      cloth_.set_relative_inverse_mass(held.particle, 0.0f);
  }
}

template <class Act>
void Effects::share_out(Crew& crew, std::uint32_t threads, const Act& act) {
  crew.run(threads, [&](std::uint32_t own) {
    cloth_.in_each_cloth(own * cloth_.rows() / threads, (own + 1) * cloth_.rows() / threads, act);
  });
}

void Effects::begin_drift(Crew& crew, std::uint32_t threads) {
  if (before_ == nullptr) return;
  const std::size_t floats = 3 * cloth_.sheet().stride;
  share_out(crew, threads, [&](const ClothRows& part) {
    const std::size_t row = part.cloth * cloth_.ny();
    for (std::size_t j = row + part.first; j < row + part.last; ++j)
      std::memcpy(before_.get() + j * floats, cloth_.row(j), floats * sizeof(float));
  });
}

void Effects::touch_solids(const Kick& kick, Crew& crew, std::uint32_t threads) {
  SolidTouch all{.nx = cloth_.nx(),
                 .solids = kick.solids,
                 .solid_count = solid_count_,
                 .has_level = ground_.has_level,
                 .has_tilt = ground_.has_tilt,
                 .floor_height = ground_.level.height,
                 .floor_friction = ground_.level.friction,
                 .tilt_normal = {ground_.tilt.normal.x, ground_.tilt.normal.y, ground_.tilt.normal.z},
                 .tilt_level = ground_.tilt.level,
                 .near = knows_near_ && kick.drift > 0.0f ? &kick.near : nullptr};
  share_out(crew, threads, [&](const ClothRows& part) {
    const std::size_t row = part.cloth * cloth_.ny();
    SolidTouch touch = all;
    touch.sheet = cloth_.sheet_of(part.cloth);
    touch.first = part.first;
    touch.last = part.last;
    touch.rows = rows_.data() + part.cloth * cloth_.padded_ny();
    touch.before = before_.get() + row * 3 * cloth_.sheet().stride;
    touch.left_over = left_over_.data() + (row + part.first) * cloth_.nx();
    const std::size_t count = kernels_.touch_solids(touch);
    for (std::size_t k = 0; k < count; ++k)
      touch_by_mirror(static_cast<std::uint32_t>(row * cloth_.nx()) + touch.left_over[k], kick);
  });
}

/// With the mirror's own code: a path that may have gone deep is searched for its entry.
void Effects::touch_by_mirror(std::uint32_t particle, const Kick& kick) {
  const std::size_t stride = cloth_.sheet().stride, j = particle / cloth_.nx(), i = particle % cloth_.nx();
  const float* const at = cloth_.row(j) + kColumns + i;
  const float* const began = before_.get() + j * 3 * stride + kColumns + i;
  const auto vector_at = [stride](const float* from) {
    return glm::vec3(from[0], from[stride], from[2 * stride]);
  };
  const glm::vec3 x0 = vector_at(began);
  glm::vec3 x1 = vector_at(at), v = vector_at(at + 3 * stride);
  for (std::uint32_t s = 0; s < solid_count_; ++s) solid_touch(solid_row_of(kick.solids[s]), x0, x1, v);
  ground_.touch(x1, v);
  cloth_.place(particle, {x1.x, x1.y, x1.z}, {v.x, v.y, v.z});
}

void Effects::kick_by_air(const Kick& kick, Crew& crew, std::uint32_t threads) {
  const std::size_t floats = 3 * cloth_.sheet().stride;
  share_out(crew, threads, [&](const ClothRows& part) {
    kernels_.air_kick({.sheet = cloth_.sheet_of(part.cloth),
                       .nx = cloth_.nx(),
                       .ny = cloth_.ny(),
                       .first = part.first,
                       .last = part.last,
                       .rows = rows_.data() + part.cloth * cloth_.padded_ny(),
                       .air = kick.air,
                       .gain = kick.gain,
                       .kicked = kicked_.get() + part.cloth * cloth_.ny() * floats});
  });
  share_out(crew, threads, [&](const ClothRows& part) {  // once nobody reads the old ones any more
    const std::size_t row = part.cloth * cloth_.ny();
    for (std::size_t j = row + part.first; j < row + part.last; ++j)
      std::memcpy(cloth_.row(j) + floats, kicked_.get() + j * floats, floats * sizeof(float));
  });
}

void Effects::tear_links(Crew& crew, std::uint32_t threads) {
  links_before_.assign(cloth_.broken_links().begin(), cloth_.broken_links().end());
  std::vector<std::uint32_t> torn(threads);
  crew.run(threads, [&](std::uint32_t own) {  // one cloth: what tears does not stand beside others
    torn[own] = kernels_.tear({.stride = cloth_.sheet().stride,
                               .nx = cloth_.nx(),
                               .ny = cloth_.ny(),
                               .first = own * cloth_.ny() / threads,
                               .last = (own + 1) * cloth_.ny() / threads,
                               .rows = rows_.data(),
                               .structural = longest_structural_m2_,
                               .shear = longest_shear_m2_,
                               .along_i = shared::kLinkAlongI,
                               .along_j = shared::kLinkAlongJ,
                               .falling = shared::kLinkFalling,
                               .rising = shared::kLinkRising,
                               .broken_links = cloth_.broken_links().data()});
  });
  if (std::ranges::count(torn, 0u) == threads) return;
  std::vector<std::uint32_t> changed;
  for (std::uint32_t p = 0; p < links_before_.size(); ++p)
    if (cloth_.broken_links()[p] != links_before_[p]) changed.push_back(p);
  cloth_.refresh_around(changed);
}

}  // namespace weft::native
