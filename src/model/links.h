// Links between neighbours, which tearing breaks: one word a particle, a bit for each broken link that the
// particle names (docs/float-form.md "Tearing").
#pragma once
#include <cstdint>
#include <span>

#include "model/model.h"
#include "shared/links.h"

namespace weft {

/// Whether a link of particle p is broken. An empty list: nothing is.
inline bool is_broken(std::span<const std::uint32_t> links, std::uint32_t p, std::uint32_t bit) {
  return !links.empty() && (links[p] & bit) != 0;
}

/// Whether the spring of a kind that starts at particle p is broken: a near one by itself, one over two cells
/// with either of the near ones beneath it.
inline bool is_broken(std::span<const std::uint32_t> links, const Grid& grid, const SpringKind& kind,
                      std::uint32_t p) {
  using namespace shared;
  if (kind.di == -1) return is_broken(links, p - 1, kLinkRising);  // named by the left particle's column
  if (kind.di == 1 && kind.dj == 1) return is_broken(links, p, kLinkFalling);
  const std::uint32_t bit = kind.dj == 0 ? kLinkAlongI : kLinkAlongJ, step = kind.dj == 0 ? 1 : grid.nx;
  if (kind.di + kind.dj == 1) return is_broken(links, p, bit);
  return is_broken(links, p, bit) || is_broken(links, p + step, bit);
}

/// Whether both links of a straight triple are whole.
inline bool is_whole_triple(std::span<const std::uint32_t> links, std::uint32_t minus, std::uint32_t middle) {
  const std::uint32_t bit = middle - minus == 1 ? shared::kLinkAlongI : shared::kLinkAlongJ;
  return !is_broken(links, minus, bit) && !is_broken(links, middle, bit);
}

/// Whether the edges of cell (i, j)'s triangle A = (i,j) (i,j+1) (i+1,j) are whole; p = (i, j).
inline bool is_whole_a(std::span<const std::uint32_t> links, std::uint32_t p) {
  return !is_broken(links, p, shared::kLinkAlongI | shared::kLinkAlongJ | shared::kLinkRising);
}

/// The same of B = (i+1,j) (i,j+1) (i+1,j+1).
inline bool is_whole_b(std::span<const std::uint32_t> links, const Grid& grid, std::uint32_t p) {
  return !is_broken(links, p, shared::kLinkRising) && !is_broken(links, p + 1, shared::kLinkAlongJ) &&
         !is_broken(links, p + grid.nx, shared::kLinkAlongI);
}

}  // namespace weft
