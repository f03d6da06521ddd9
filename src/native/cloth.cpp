// Lays a model out for the kernels: every number is computed in double and rounded once, as for the shaders.
#include "native/cloth.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <new>
#include <string>

#include "passes/coefficients.h"
#include "passes/contact.h"
#include "passes/integrate.h"

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

/// How many triples have the pair (place, place + 1) of a line as neighbours.
std::size_t triples_of(std::size_t place, std::size_t count) {
  return (place >= 1 ? 1u : 0u) + (place + 2 < count ? 1u : 0u);
}

/// The coefficients of one particle's forward pairs; null where the pair does not exist.
class PairRows {
 public:
  explicit PairRows(const Model& model)
      : rows_(spring_rows<float>(model)), nx_(model.grid.nx), ny_(model.grid.ny) {}

  const glm::vec4* find(PairName pair, std::size_t i, std::size_t j) const {
    const bool right = i + 1 < nx_, below = j + 1 < ny_;
    const std::size_t column_edge = i == 0 || !right ? 1 : 0, row_edge = j == 0 || !below ? 1 : 0;
    switch (pair) {
      case kPair01: return below ? &rows_.structural[(2 + column_edge) * 3 + triples_of(j, ny_)] : nullptr;
      case kPair10: return right ? &rows_.structural[row_edge * 3 + triples_of(i, nx_)] : nullptr;
      case kPairT:
      case kPair11: return right && below ? &rows_.shear : nullptr;
      case kPair20: return i + 2 < nx_ ? &rows_.flex[row_edge] : nullptr;
      case kPair02: return j + 2 < ny_ ? &rows_.flex[2 + column_edge] : nullptr;
      case kPairCount: break;
    }
    return nullptr;
  }

 private:
  SpringRows<float> rows_;
  std::size_t nx_, ny_;
};

Block make_block(const Model& model, const PairRows& rows, std::size_t first, std::size_t j) {
  Block block{};
  const auto interior = static_cast<float>(1.0 / model.interior_mass_kg);
  for (std::size_t lane = 0; lane < kColumns; ++lane) {
    const std::size_t i = first + lane;
    if (i < model.grid.nx) {
      const double relative = model.relative_inverse_mass[j * model.grid.nx + i];
      block.inverse_mass[lane] = static_cast<float>(relative) * interior;
      for (int pair = 0; pair < kPairCount; ++pair) {
        const glm::vec4* row = rows.find(static_cast<PairName>(pair), i, j);
        if (row == nullptr) continue;
        block.pairs[pair].k[lane] = row->x;
        block.pairs[pair].l[lane] = row->y;
        block.pairs[pair].c[lane] = row->z;
      }
    }
    if (block.inverse_mass[lane] == 0.0f) block.has_fixed = 1;
  }
  return block;
}

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

}  // namespace

void AlignedDelete::operator()(float* memory) const { ::operator delete[](memory, kVectorAlignment); }

Floats make_floats(std::size_t count) {
  auto* memory = static_cast<float*>(::operator new[](count * sizeof(float), kVectorAlignment));
  std::fill_n(memory, count, 0.0f);
  return Floats(memory);
}

KickTable::KickTable(const Model& model, std::span<const KickDrift> rows) {
  const std::size_t per_row = model.scene.spheres.size();
  spheres_.reserve(rows.size() * per_row);
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
    for (const SphereRow<float>& at : row.spheres) {
      Sphere sphere{.reach = at.reach, .friction = at.friction};
      copy(at.center, sphere.center);
      copy(at.travel, sphere.travel);
      copy(at.velocity, sphere.velocity);
      spheres_.push_back(sphere);
    }
    kicks_.push_back(kick);
  }
}

Cloth::Cloth(const Model& model, std::span<const Constant> constants, std::size_t pad)
    : nx_(model.grid.nx), ny_(model.grid.ny), variant_(variant_of(constants)) {
  sheet_.stride = stride_for(nx_, pad);
  sheet_.block_count = (nx_ + kColumns - 1) / kColumns;
  state_ = make_floats((ny_ + 2) * row_floats());
  relative_inverse_mass_.assign(model.relative_inverse_mass.begin(), model.relative_inverse_mass.end());
  make_blocks(model);
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

void Cloth::make_blocks(const Model& model) {
  const PairRows rows(model);
  std::map<std::string, std::uint32_t> known;  // a block's bytes → its place
  block_of_.reserve(ny_ * sheet_.block_count);
  for (std::size_t j = 0; j < ny_; ++j) {
    for (std::size_t b = 0; b < sheet_.block_count; ++b) {
      const Block block = make_block(model, rows, b * kColumns, j);
      const std::string bytes(reinterpret_cast<const char*>(&block), sizeof block);
      const auto [place, is_new] = known.try_emplace(bytes, static_cast<std::uint32_t>(blocks_.size()));
      if (is_new) blocks_.push_back(block);
      block_of_.push_back(place->second);
    }
  }
  sheet_.blocks = blocks_.data();
  sheet_.block_of = block_of_.data();
}

std::uint64_t Cloth::bytes() const {
  return (ny_ + 2) * row_floats() * sizeof(float) + blocks_.size() * sizeof(Block) +
         block_of_.size() * sizeof(std::uint32_t) + relative_inverse_mass_.size() * sizeof(float);
}

void Cloth::load(const HostBuffers<float>& buffers) {
  for (std::size_t j = 0; j < ny_; ++j) {
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
