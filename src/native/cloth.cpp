// Lays a model out for the kernels: every number is computed in double and rounded once, as for the shaders.
#include "native/cloth.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <new>
#include <span>

#include "passes/coefficients.h"
#include "passes/contact.h"
#include "passes/integrate.h"
#include "passes/reach.h"

namespace weft::native {
namespace {

constexpr std::align_val_t kVectorAlignment{64};

/// Six rows apart by nearly a multiple of a page would all fall into the same few lines of the cache.
std::size_t stride_for(std::size_t nx, std::size_t pad) {
  std::size_t stride = (nx + kColumns - 1) / kColumns * kColumns + kColumns + pad;
  const auto near_page = [](std::size_t bytes) { return bytes % 4096 < 192 || bytes % 4096 > 4096 - 192; };
  while (near_page(24 * stride) || near_page(4 * stride)) stride += kColumns;
  return stride;
}

void copy(const glm::vec3& from, float (&to)[3]) { to[0] = from.x, to[1] = from.y, to[2] = from.z; }

bool is_on(std::span<const Constant> constants, IntegrateConstant id) {
  for (const Constant& constant : constants)
    if (constant.name == kIntegrateConstantNames[id]) return constant.value != 0;
  return false;
}

std::uint32_t variant_of(std::span<const Constant> constants) {
  const auto bit = [&](std::uint32_t effect, auto... ids) {
    return (is_on(constants, ids) || ...) ? effect : 0u;
  };
  return bit(kDamping, kHasDamping) | bit(kShear, kHasShear) | bit(kTwoApart, kHasFlex, kHasBending) |
         bit(kAir, kHasAir) | bit(kContact, kHasFloor, kHasSpheres);
}

Solid solid_of(const SolidRow<float>& row) {
  Solid solid{.reach = row.reach, .deep = row.deep, .friction = row.friction};
  copy(row.center, solid.center);
  copy(row.start, solid.start);
  copy(row.velocity, solid.velocity);
  copy(row.spin, solid.spin);
  copy(row.half, solid.half);
  for (int axis = 0; axis < 3; ++axis) {
    copy(row.axes[axis], solid.axes[axis]);
    copy(row.start_axes[axis], solid.start_axes[axis]);
  }
  return solid;
}

/// What touch_sphere computes of a drift keeps to the law of Clear: it takes the distance at the nearest
/// point from squares of distances, and 200 radii of way would lose the 2 % that are between reach and depth.
Clear clear_of(std::span<const SphereRow<float>> spheres) {
  constexpr double kWayInRadii = 100.0, kMoreOfRadius = 1e-3, kMoreOfPlace = 1e-5;
  constexpr auto kInfinite = std::numeric_limits<float>::infinity();
  Clear clear{{kInfinite, kInfinite, kInfinite}, {-kInfinite, -kInfinite, -kInfinite}, 0.0f};
  double leap = std::numeric_limits<float>::max();
  for (const SphereRow<float>& sphere : spheres) {
    const glm::dvec3 center(sphere.center), travel(sphere.travel);
    const double place = glm::length(center) + glm::length(travel);
    const double half = sphere.reach * (1.0 + kMoreOfRadius) + kMoreOfPlace * place;
    const glm::dvec3 low = glm::min(center, center - travel), high = glm::max(center, center - travel);
    for (int axis = 0; axis < 3; ++axis) {
      clear.low[axis] = std::min(clear.low[axis], static_cast<float>(low[axis] - half));
      clear.high[axis] = std::max(clear.high[axis], static_cast<float>(high[axis] + half));
    }
    leap = std::min(leap, kWayInRadii * sphere.reach - glm::length(travel));
  }
  clear.leap2 = leap > 0.0 ? static_cast<float>(std::min(leap * leap, 1e38)) : -1.0f;
  return clear;
}

/// Where bodies are near; what is clear of spheres is then clear of them too.
Near near_of(const Model& model, const KickDrift& kick, Clear& clear) {
  constexpr float kLessThanLeap = 0.99f;  // for a way that was not yet rounded to places
  const ReachRow<float> reach = reach_row<float>(model, kick);
  Near near{.leap = reach.leap};
  copy(reach.low, near.low);
  copy(reach.high, near.high);
  for (int axis = 0; axis < 3; ++axis) {
    clear.low[axis] = std::min(clear.low[axis], near.low[axis]);
    clear.high[axis] = std::max(clear.high[axis], near.high[axis]);
  }
  const float leap = kLessThanLeap * near.leap;
  clear.leap2 = std::min(clear.leap2, leap * leap);
  return near;
}

Air air_of(const Model& model, const KickDrift& kick) {
  const AirRow<float> row = air_row<float>(model, kick);
  Air air{.cells_1_m = row.cells_1_m,
          .slice_share = row.slice_share,
          .noise_m_s = row.noise_m_s,
          .drag = row.drag,
          .lift = row.lift,
          .slice = static_cast<std::uint32_t>(row.slice),
          .seed = model.scene.wind ? model.scene.wind->seed : 0,
          .has_noise = has_wind_noise(model.scene),
          .noise_farthest = shared::kNoiseFarthest,
          .noise_period_mask = shared::kNoisePeriodMask};
  copy(row.wind, air.wind);
  copy(row.origin, air.origin);
  return air;
}

}  // namespace

void AlignedDelete::operator()(float* memory) const { ::operator delete[](memory, kVectorAlignment); }

Floats make_floats(std::size_t count) {
  auto* memory = static_cast<float*>(::operator new[](count * sizeof(float), kVectorAlignment));
  std::fill_n(memory, count, 0.0f);
  return Floats(memory);
}

KickTable::KickTable(const Model& model, std::span<const KickDrift> rows) {
  spheres_.reserve(rows.size() * model.scene.spheres.size());
  pins_.reserve(rows.size() * model.moved_pins.size());
  air_.reserve(rows.size());
  solids_.reserve(rows.size() * solid_count(model));
  meshes_.reserve(rows.size() * model.meshes.size());
  kicks_.reserve(rows.size());
  for (const KickDrift& from : rows) {
    const SubstepRow<float> row = substep_row<float>(model, from);
    Kick kick{.loss = row.loss,
              .gain = row.gain,
              .drift = row.drift,
              .predict_loss = row.predict_loss,
              .predict_gain = row.predict_gain,
              .begins_frame = kicks_.empty() ? 1u : 0u};
    copy(row.alpha_wind, kick.alpha_wind);
    kick.spheres = spheres_.data() + spheres_.size();
    kick.clear = clear_of(row.spheres);
    if (asks_bodies(model)) kick.near = near_of(model, from, kick.clear);
    for (const SphereRow<float>& at : row.spheres) {
      Sphere sphere{.reach = at.reach, .friction = at.friction};
      copy(at.center, sphere.center);
      copy(at.travel, sphere.travel);
      copy(at.velocity, sphere.velocity);
      spheres_.push_back(sphere);
    }
    if (model.scene.aerodynamics) kick.air = &air_.emplace_back(air_of(model, from));
    kick.solids = solids_.data() + solids_.size();
    for (const SolidRow<float>& solid : row.solids) solids_.push_back(solid_of(solid));
    kick.meshes = meshes_.data() + meshes_.size();
    for (const SolidRow<float>& mesh : row.meshes) meshes_.push_back(solid_of(mesh));
    kick.pins = pins_.data() + pins_.size();
    for (const PinRow<float>& at : row.pins) {
      PinPlace pin{.released = at.released ? 1u : 0u};
      copy(at.offset, pin.offset);
      copy(at.velocity, pin.velocity);
      pins_.push_back(pin);
    }
    kicks_.push_back(kick);
  }
}

Cloth::Cloth(const Model& model, std::span<const Constant> constants, std::size_t pad, bool looks_at_drifts)
    : nx_(model.grid.nx),
      ny_(model.grid.ny),
      rows_(model.grid.rows()),
      variant_(variant_of(constants) | (looks_at_drifts ? kContact : 0u)),
      relative_inverse_mass_(model.relative_inverse_mass.begin(), model.relative_inverse_mass.end()),
      broken_links_(model.scene.tearing ? model.grid.count() : 0),
      blocks_(model, changes()) {
  sheet_.stride = stride_for(nx_, pad);
  state_ = make_floats(model.grid.cloths * padded_ny() * row_floats());
  point_at_blocks();
  if (is_on(constants, kHasGravity)) copy(model.scene.gravity->acceleration_m_s2, outside_.gravity);
  outside_.has_gravity = is_on(constants, kHasGravity);
  outside_.has_wind = is_on(constants, kHasWind);
  outside_.has_floor = is_on(constants, kHasFloor);
  outside_.sphere_count = is_on(constants, kHasSpheres) ? std::uint32_t(model.scene.spheres.size()) : 0;
  if (outside_.has_floor != 0) {
    const FloorRow<float> floor = floor_row<float>(model);
    outside_.floor_height = floor.height;
    outside_.floor_friction = floor.friction;
  }
}

std::uint64_t Cloth::bytes() const {
  const std::size_t states = kept_ ? 2 : 1;
  return states * padded_place(rows_) * row_floats() * sizeof(float) + blocks_.bytes() +
         relative_inverse_mass_.size() * sizeof(float) + broken_links_.size() * sizeof(std::uint32_t);
}

Sheet Cloth::sheet_of(std::size_t cloth) const {
  Sheet sheet = sheet_;
  sheet.block_of += cloth * ny_ * sheet.block_count;
  return sheet;
}

std::vector<float*> Cloth::padded_rows() {
  std::vector<float*> rows;
  for (std::size_t place = 0; place < padded_place(rows_); ++place)
    rows.push_back(state_.get() + place * row_floats());
  return rows;
}

void Cloth::make_keep() {
  if (kept_ == nullptr) kept_ = make_floats(padded_place(rows_) * row_floats());
}

void Cloth::keep(std::size_t first, std::size_t last) {
  for (std::size_t j = first; j < last; ++j)
    std::copy_n(row(j), row_floats(), kept_.get() + padded_place(j) * row_floats());
}

void Cloth::take_back(std::size_t first, std::size_t last) {
  for (std::size_t j = first; j < last; ++j)
    std::copy_n(kept_.get() + padded_place(j) * row_floats(), row_floats(), row(j));
}

void Cloth::point_at_blocks() {
  sheet_.block_count = blocks_.per_row();
  sheet_.blocks = blocks_.data();
  sheet_.block_of = blocks_.of();
}

void Cloth::refresh_around(std::span<const std::uint32_t> particles) {
  for (const std::uint32_t particle : particles) blocks_.refresh_around(particle, changes());
  point_at_blocks();
}

void Cloth::set_relative_inverse_mass(std::uint32_t particle, float relative) {
  relative_inverse_mass_[particle] = relative;
  blocks_.refresh(particle / nx_, particle % nx_ / kColumns, changes());
  point_at_blocks();
}

void Cloth::place(std::uint32_t particle, const float (&x)[3], const float (&v)[3]) {
  float* at = row(particle / nx_) + kColumns + particle % nx_;
  for (int axis = 0; axis < 3; ++axis) {
    at[axis * sheet_.stride] = x[axis];
    at[(3 + axis) * sheet_.stride] = v[axis];
  }
}

bool Cloth::take_changes(const HostBuffers<float>& buffers) {
  const auto& position = buffers[BufferId::position];
  const auto& links = buffers.words_of(BufferId::broken_links);
  std::vector<std::uint32_t> changed;
  for (std::uint32_t p = 0; p < position.size(); ++p) {
    const bool torn = !links.empty() && links[p] != broken_links_[p];
    if (!torn && position[p].w == relative_inverse_mass_[p]) continue;
    relative_inverse_mass_[p] = position[p].w;
    if (torn) broken_links_[p] = links[p];
    changed.push_back(p);
  }
  refresh_around(changed);
  return !changed.empty();
}

void Cloth::load(const HostBuffers<float>& buffers, std::size_t first, std::size_t last) {
  for (std::size_t j = first; j < last; ++j) {
    float* at = row(j) + kColumns;
    const glm::vec4* x = buffers[BufferId::position].data() + j * nx_;
    const glm::vec4* v = buffers[BufferId::velocity].data() + j * nx_;
    for (std::size_t i = 0; i < nx_; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        at[axis * sheet_.stride + i] = x[i][axis];
        at[(3 + axis) * sheet_.stride + i] = v[i][axis];
      }
    }
  }
}

}  // namespace weft::native
