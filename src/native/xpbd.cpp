// The order of the colours is the plan's; what each pulls follows from its item (passes/spring_colours.h).
#include "native/xpbd.h"

#include <algorithm>
#include <cmath>

#include "native/thread_speeds.h"
#include "passes/integrate.h"
#include "passes/passes.h"
#include "passes/xpbd.h"
#include "passes/xpbd_tethers.h"

namespace weft::native {
namespace {

constexpr std::uint32_t kSeveralAnchors = 1u << 31;

bool is_set(std::span<const Constant> constants, IntegrateConstant id) {
  return std::ranges::any_of(
      constants, [&](const Constant& c) { return c.name == kIntegrateConstantNames[id] && c.value != 0; });
}

XpbdKind kind_of(SpringName spring) {
  switch (spring) {
    case kStructuralI: return kPullI;
    case kStructuralJ: return kPullJ;
    case kShearDown: return kPullDown;
    case kShearUp: return kPullUp;
    case kFlexI: return kPullTwoI;
    default: return kPullTwoJ;
  }
}

}  // namespace

Xpbd::Xpbd(Cloth& cloth, const Kernels& kernels, const Model& model, const Plan& plan,
           const BodyTouch* bodies)
    : cloth_(cloth),
      kernels_(kernels),
      moved_bytes_(cloth.rows() * 4 * cloth.sheet().stride * sizeof(float)),
      moved_(make_floats(moved_bytes_ / sizeof(float))),
      bodies_(bodies),
      interior_(static_cast<float>(1.0 / model.interior_mass_kg)),
      anchors_move_(!model.moved_pins.empty()),
      turns_(cloth.rows() / kRowsPerBandMin + 1) {
  const std::size_t stride = cloth.sheet().stride;
  move_.sheet = {stride, cloth.nx(), cloth.ny(), cloth.row(0), moved_.get()};
  move_.outside = cloth.outside();
  take_masses();
  for (const PlanStep& step : plan.steps) {
    if (step.pass == &xpbd_predict) move_.has_air = is_set(step.constants, kHasAir);
    if (step.pass == &xpbd_spring || step.pass == &xpbd_bend) colours_.push_back(colour_of(step, model));
    if (step.pass == &xpbd_pins) placed_ = model.moved_particles;
    if (step.pass == &xpbd_tethers) tethers_ = make_tethers<float>(model);
  }
  if (!tethers_.empty()) make_tether_rows();
  move_.has_contact = cloth.outside().has_floor != 0 || cloth.outside().sphere_count > 0;
}

void Xpbd::take_masses() {
  for (std::size_t j = 0; j < cloth_.rows(); ++j)
    for (std::size_t i = 0; i < cloth_.nx(); ++i)
      moved_[(4 * j + 3) * cloth_.sheet().stride + kColumns + i] =
          cloth_.relative_inverse_mass()[j * cloth_.nx() + i] * interior_;
}

Xpbd::Colour Xpbd::colour_of(const PlanStep& step, const Model& model) const {
  const ConstraintRows<float> rows = constraint_rows<float>(model);
  const bool bends = step.pass == &xpbd_bend;
  const bool damped = !bends && is_set(step.constants, kHasDamping);
  const SpringColour spring = SpringColour::of(step.item);
  const XpbdKind kind = bends ? (step.item < 3 ? kBendI : kBendJ) : kind_of(spring.kind);
  std::size_t inside = shared::kConstraintBend, edge = shared::kConstraintBend + 1;
  if (kind == kPullI || kind == kPullJ) inside = shared::kConstraintStructural, edge = inside + 1;
  if (kind == kPullDown || kind == kPullUp) inside = edge = shared::kConstraintShear;
  if (kind == kPullTwoI || kind == kPullTwoJ) inside = shared::kConstraintFlex, edge = inside + 1;
  Colour colour{.pull = kernels_.xpbd_pull[damped ? 1 : 0][kind], .what = {}, .reach = 0};
  colour.what = {.sheet = move_.sheet,
                 .colour = bends ? step.item % 3 : spring.colour,
                 .compliance = rows[inside].y,
                 .compliance_edge = rows[edge].y,
                 .rest = rows[inside].x,
                 .damping_time = rows[inside].z};
  if (kind == kPullJ || kind == kPullDown || kind == kPullUp) colour.reach = 1;
  if (kind == kPullTwoJ || kind == kBendJ) colour.reach = 2;
  return colour;
}

Xpbd::Band Xpbd::band_of(std::uint32_t own, std::uint32_t count) {
  const std::vector<std::size_t> borders = band_borders(cloth_, std::vector<double>(count, 1.0));
  Band band{.first = borders[own], .last = borders[own + 1], .own = own, .count = count};
  band.goes_on_above = band.first % cloth_.ny() != 0;
  band.goes_on_below = band.last % cloth_.ny() != 0;
  cloth_.in_each_cloth(band.first, band.last, [&](const ClothRows& rows) {
    const std::size_t row = rows.cloth * cloth_.ny();
    XpbdMove& part = band.parts.emplace_back(move_);
    part.sheet.state = cloth_.row(row);
    part.sheet.moved += row * 4 * part.sheet.stride;
    part.first = rows.first;
    part.last = rows.last;
    if (bodies_ != nullptr) part.bodies = bodies_->bodies(drifted_[own].data());
  });
  return band;
}

/// Marks the turn as done and waits until both neighbours that share a cloth with this band have done it too.
void Xpbd::end_turn(Band& band) {
  raise(turns_[band.own].done, ++band.turn);
  const int looks = patience_of(band.count).for_neighbour;
  if (band.goes_on_above) wait_for(turns_[band.own - 1].done, band.turn, looks);
  if (band.goes_on_below) wait_for(turns_[band.own + 1].done, band.turn, looks);
}

/// How far moving pins take what they hold of the band's rows.
void Xpbd::move_pins(const Band& band, const Kick& kick) {
  const std::size_t stride = move_.sheet.stride, nx = move_.sheet.nx;
  auto held = std::ranges::lower_bound(placed_, band.first * nx, {}, &MovedParticle::particle);
  for (; held != placed_.end() && held->particle / nx < band.last; ++held) {
    const PinPlace& pin = kick.pins[held->pin];
    if (pin.released != 0) continue;
    float* const moved =
        move_.sheet.moved + held->particle / nx * 4 * stride + kColumns + held->particle % nx;
    for (std::size_t axis = 0; axis < 3; ++axis) moved[axis * stride] = kick.drift * pin.velocity[axis];
  }
}

/// Particles beside each other mostly hang from the same anchor, and then a vector of them does.
void Xpbd::make_tether_rows() {
  const std::size_t stride = move_.sheet.stride, nx = cloth_.nx(), blocks = (nx + kColumns - 1) / kColumns;
  for (const shared::TetherOf<float>& tether : tethers_) anchor_particles_.push_back(tether.anchor);
  std::ranges::sort(anchor_particles_);
  anchor_particles_.erase(std::ranges::unique(anchor_particles_).begin(), anchor_particles_.end());
  tether_reach_.assign(cloth_.rows() * stride, -1.0f);
  std::uint32_t several = 0;
  for (std::size_t j = 0; j < cloth_.rows(); ++j)
    for (std::size_t b = 0; b < blocks; ++b) {
      const auto anchor_of = [&](std::size_t i) { return place_among(tethers_[j * nx + i].anchor); };
      std::uint32_t& all = anchors_.emplace_back(anchor_of(kColumns * b));
      for (std::size_t i = kColumns * b; i < std::min(nx, kColumns * (b + 1)); ++i) {
        tether_reach_[j * stride + i] = tethers_[j * nx + i].reach_m;
        if (anchor_of(i) != all) all = kSeveralAnchors;
      }
      if (all == kSeveralAnchors) all += several++;
    }
  if (!anchors_move_) several_.resize(3 * kColumns * several);
  all_tethers_ = {.reach = tether_reach_.data(),
                  .anchors = anchors_.data(),
                  .blocks = blocks,
                  .no_anchor = kSeveralAnchors};
}

std::uint32_t Xpbd::place_among(std::uint32_t anchor) const {
  return static_cast<std::uint32_t>(std::ranges::lower_bound(anchor_particles_, anchor) -
                                    anchor_particles_.begin());
}

/// As XpbdTethers has them.
std::vector<float> Xpbd::anchor_places() {
  const std::size_t stride = move_.sheet.stride, nx = cloth_.nx();
  std::vector<float> places;
  for (const std::uint32_t p : anchor_particles_) {
    const float *const start = cloth_.row(p / nx) + kColumns + p % nx, *const moved = move_.sheet.moved +
                                                                                      p / nx * 4 * stride +
                                                                                      kColumns + p % nx;
    for (std::size_t axis = 0; axis < 3; ++axis) places.push_back(start[axis * stride]);
    for (std::size_t axis = 0; axis < 3; ++axis)
      places.push_back(anchors_move_ ? moved[axis * stride] : 0.0f);
  }
  return places;
}

/// Where anchors are that stand still; those that differ within a block, by particle.
void Xpbd::find_still_anchors() {
  std::vector<float> places = anchor_places();
  if (places == still_places_) return;
  still_places_ = std::move(places);
  const std::size_t nx = cloth_.nx(), blocks = all_tethers_.blocks;
  for (std::size_t at = 0; at < anchors_.size(); ++at) {
    if ((anchors_[at] & kSeveralAnchors) == 0) continue;
    float* const to = several_.data() + 3 * kColumns * (anchors_[at] & ~kSeveralAnchors);
    const std::size_t first = at % blocks * kColumns;
    for (std::size_t i = first; i < std::min(nx, first + kColumns); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        to[axis * kColumns + i - first] =
            still_places_[6 * std::size_t{place_among(tethers_[at / blocks * nx + i].anchor)} + axis];
  }
}

/// Tethers whose anchors stand still row by row, while its places are at hand.
void Xpbd::end_substep(const XpbdMove& part) const {
  if (tethers_.empty() || anchors_move_) return kernels_.xpbd_finish(part);
  XpbdTethers tethers = all_tethers_;
  tethers.sheet = part.sheet;
  tethers.places = still_places_.data();
  tethers.several = several_.data();
  XpbdMove row = part;
  for (std::size_t j = part.first; j < part.last; ++j) {
    tethers.first = row.first = j;
    tethers.last = row.last = j + 1;
    kernels_.xpbd_tethers(tethers);
    kernels_.xpbd_finish(row);
  }
}

/// Of rows [first, last) of the one cloth there is.
void Xpbd::pull_tethers(std::size_t first_row, std::size_t last_row, const std::vector<float>& places) {
  XpbdTethers tethers = all_tethers_;
  tethers.sheet = move_.sheet;
  tethers.first = first_row;
  tethers.last = last_row;
  tethers.places = places.data();
  kernels_.xpbd_tethers(tethers);
  const std::size_t nx = cloth_.nx(), blocks = tethers.blocks;
  for (std::size_t at = first_row * blocks; at < last_row * blocks; ++at) {
    if ((anchors_[at] & kSeveralAnchors) == 0) continue;
    const std::size_t row = at / blocks * nx, first = at % blocks * kColumns;
    for (std::size_t i = first; i < std::min(nx, first + kColumns); ++i)
      pull_tether(row + i, &places[6 * std::size_t{place_among(tethers_[row + i].anchor)}]);
  }
}

void Xpbd::pull_tether(std::size_t particle, const float* anchor) {
  const std::size_t stride = move_.sheet.stride, nx = move_.sheet.nx;
  const float* const start = cloth_.row(particle / nx) + kColumns + particle % nx;
  float* const moved = move_.sheet.moved + particle / nx * 4 * stride + kColumns + particle % nx;
  const float reach_m = tethers_[particle].reach_m;
  if (moved[3 * stride] == 0.0f || reach_m < 0.0f) return;
  float d[3];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t at = axis * stride;
    d[axis] = (start[at] - anchor[axis]) + (moved[at] - anchor[3 + axis]);
  }
  const float q = (d[0] * d[0] + d[1] * d[1]) + d[2] * d[2];
  if (!(q > reach_m * reach_m)) return;
  const float l = std::sqrt(q), share = (l - reach_m) * (1.0f / l);
  for (std::size_t axis = 0; axis < 3; ++axis) moved[axis * stride] = moved[axis * stride] - share * d[axis];
}

void Xpbd::pull(const Colour& colour, const Kick& kick, Band& band) {
  XpbdPull pull = colour.what;
  pull.step = kick.drift;
  for (const XpbdMove& part : band.parts) {
    const bool reaches_on = band.goes_on_below && &part == &band.parts.back();
    pull.sheet = part.sheet;
    pull.first = part.first;
    pull.last = reaches_on ? part.last - colour.reach : part.last;
    colour.pull(pull);
  }
  if (colour.reach == 0 || band.count == 1) return;
  end_turn(band);
  if (band.goes_on_below) {
    pull.first = pull.last;
    pull.last = band.parts.back().last;
    colour.pull(pull);
  }
  end_turn(band);
}

void Xpbd::sweep_band(Band band, std::span<const Kick> kicks) {
  for (const Kick& kick : kicks) {
    for (XpbdMove& part : band.parts) {
      part.kick = &kick;
      kernels_.xpbd_predict(part);
    }
    move_pins(band, kick);
    for (const Colour& colour : colours_) pull(colour, kick, band);
    if (!tethers_.empty() && anchors_move_) {
      // Anchors may be any band's: all of them wait for all, before these are read and before they move on.
      // Tethers stand beside one cloth alone, so that every band waits for both its neighbours.
      const auto end_turns = [&] {
        for (std::uint32_t other = 1; other < band.count; ++other) end_turn(band);
      };
      end_turns();
      pull_tethers(band.first, band.last, anchor_places());
      end_turns();
    }
    for (const XpbdMove& part : band.parts) end_substep(part);
  }
}

void Xpbd::sweep(Crew& crew, std::uint32_t threads, std::span<const Kick> kicks) {
  for (Turns& turns : turns_) turns.done.store(0, std::memory_order_relaxed);
  if (!tethers_.empty() && !anchors_move_) find_still_anchors();
  drifted_.resize(std::max<std::size_t>(drifted_.size(), threads));
  for (std::vector<Drifted>& list : drifted_)
    if (bodies_ != nullptr) list.resize(BodyTouch::room(cloth_.nx()));
  crew.run(threads, [&](std::uint32_t own) { sweep_band(band_of(own, threads), kicks); });
}

}  // namespace weft::native
