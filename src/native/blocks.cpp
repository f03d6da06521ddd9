// Every number is computed in double and rounded once, as for the shaders.
#include "native/blocks.h"

#include <algorithm>

#include "model/links.h"

namespace weft::native {

Blocks::Blocks(const Model& model, const ClothChanges& now)
    : grid_(model.grid),
      rows_(spring_rows<float>(model)),
      interior_(static_cast<float>(1.0 / model.interior_mass_kg)),
      per_row_((model.grid.nx + kColumns - 1) / kColumns),
      of_(model.grid.rows() * per_row_) {
  for (std::size_t j = 0; j < grid_.rows(); ++j)
    for (std::size_t b = 0; b < per_row_; ++b) refresh(j, b, now);
}

std::uint64_t Blocks::bytes() const {
  return blocks_.size() * sizeof(Block) + of_.size() * sizeof(std::uint32_t);
}

/// The coefficients of one of a particle's forward pairs; null where it does not exist or is broken. With
/// broken links: docs/float-form.md "Tearing".
const glm::vec4* Blocks::find(PairName pair, std::size_t i, std::size_t row_of_all,
                              const ClothChanges& now) const {
  const std::size_t nx = grid_.nx, ny = grid_.ny, j = row_of_all % ny;
  const bool right = i + 1 < nx, below = j + 1 < ny;
  const std::size_t column_edge = i == 0 || !right ? 1 : 0, row_edge = j == 0 || !below ? 1 : 0;
  const auto p = static_cast<std::uint32_t>(row_of_all * nx + i);
  const auto whole = [&](std::uint32_t named, std::uint32_t bit) {
    return !is_broken(now.broken_links, named, bit);
  };
  const auto near = [&](std::size_t place, std::size_t count, std::uint32_t step, std::uint32_t bit,
                        std::size_t row) -> const glm::vec4* {
    if (place + 1 >= count || !whole(p, bit)) return nullptr;
    const std::size_t triples = (place >= 1 && whole(p - step, bit) ? 1u : 0u) +
                                (place + 2 < count && whole(p + step, bit) ? 1u : 0u);
    return &rows_.structural[row * 3 + triples];
  };
  const auto far = [&](std::size_t place, std::size_t count, std::uint32_t step, std::uint32_t bit,
                       std::size_t row) -> const glm::vec4* {
    return place + 2 < count && whole(p, bit) && whole(p + step, bit) ? &rows_.flex[row] : nullptr;
  };
  using namespace shared;
  switch (pair) {
    case kPair01: return near(j, ny, grid_.nx, kLinkAlongJ, 2 + column_edge);
    case kPair10: return near(i, nx, 1, kLinkAlongI, row_edge);
    case kPairT: return right && below && whole(p, kLinkRising) ? &rows_.shear : nullptr;
    case kPair11: return right && below && whole(p, kLinkFalling) ? &rows_.shear : nullptr;
    case kPair20: return far(i, nx, 1, kLinkAlongI, row_edge);
    case kPair02: return far(j, ny, grid_.nx, kLinkAlongJ, 2 + column_edge);
    case kPairCount: break;
  }
  return nullptr;
}

Block Blocks::make(std::size_t j, std::size_t b, const ClothChanges& now) const {
  Block block{};
  for (std::size_t lane = 0; lane < kColumns; ++lane) {
    const std::size_t i = b * kColumns + lane;
    if (i < grid_.nx) {
      block.inverse_mass[lane] = now.relative_inverse_mass[j * grid_.nx + i] * interior_;
      for (int pair = 0; pair < kPairCount; ++pair) {
        const glm::vec4* row = find(static_cast<PairName>(pair), i, j, now);
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

void Blocks::refresh(std::size_t j, std::size_t b, const ClothChanges& now) {
  const Block block = make(j, b, now);
  const std::string bytes(reinterpret_cast<const char*>(&block), sizeof block);
  const auto [place, is_new] = known_.try_emplace(bytes, static_cast<std::uint32_t>(blocks_.size()));
  if (is_new) blocks_.push_back(block);
  of_[j * per_row_ + b] = place->second;
}

void Blocks::refresh_around(std::uint32_t particle, const ClothChanges& now) {
  const std::size_t i = particle % grid_.nx, j = particle / grid_.nx;
  const std::size_t last_row = std::min<std::size_t>(j + 1, grid_.rows() - 1);
  const std::size_t last_column = std::min<std::size_t>(i + 1, grid_.nx - 1);
  for (std::size_t row = j == 0 ? 0 : j - 1; row <= last_row; ++row)
    for (std::size_t b = (i == 0 ? 0 : i - 1) / kColumns; b <= last_column / kColumns; ++b)
      refresh(row, b, now);
}

}  // namespace weft::native
