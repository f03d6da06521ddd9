// watch: the fastest particle and the kinetic energy of each piece of the cloth. Declaration and CPU mirror.
#include <algorithm>
#include <bit>
#include <cmath>

#include "model/speed_budget.h"
#include "passes/passes.h"

namespace weft {
namespace {

/// Rows of pieces: the last may be shorter.
std::uint32_t piece_rows(const Grid& grid) {
  return (grid.rows() + shared::kWatchRows - 1) / shared::kWatchRows;
}

template <class T>
T squared(const glm::vec<4, T>& a) {
  return (a.x * a.x + a.y * a.y) + a.z * a.z;
}

struct Part {
  std::uint32_t fastest, particle, energy;
};

template <class T>
void look_at(const glm::vec<4, T>& x, const glm::vec<4, T>& v, std::uint32_t p, T energy_share, Part& part) {
  const T q = squared(v);
  const bool finite = std::isfinite(static_cast<float>(q)) && std::isfinite(static_cast<float>(squared(x)));
  const bool moves = finite && x.w != T(0) && q > T(shared::kWatchSpeedSquaredMin);
  std::uint32_t key = moves ? std::bit_cast<std::uint32_t>(static_cast<float>(q)) : 0;
  if (!finite) key = shared::kWatchNotFinite;
  if (key > part.fastest) {
    part.fastest = key;
    part.particle = p;
  }
  if (!moves) return;
  const T mass = T(1) / x.w, share = (q * mass) * energy_share;
  const auto whole = static_cast<std::uint32_t>(std::min(share, T(shared::kWatchShareMost)));
  part.energy = std::min(part.energy + whole, shared::kWatchMost);
}

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const Grid& grid = context.model.grid;
  const T energy_share =
      static_cast<T>(energy_share_s2_m2(free_mass_ratio(context.model), context.speed_allowed_m_s));
  const std::uint32_t parts = grid.nx * piece_rows(grid);
  auto& words = buffers.words_of(BufferId::watch_parts);
  for (std::uint32_t at = 0; at < parts; ++at) {
    const std::uint32_t i = at % grid.nx, first = at / grid.nx * shared::kWatchRows;
    Part part{0, grid.index(i, first), 0};
    for (std::uint32_t j = first; j < std::min(grid.rows(), first + shared::kWatchRows); ++j) {
      const std::uint32_t p = grid.index(i, j);
      look_at(buffers[BufferId::position][p], buffers[BufferId::velocity][p], p, energy_share, part);
    }
    words[shared::kPartFastest * parts + at] = part.fastest;
    words[shared::kPartParticle * parts + at] = part.particle;
    words[shared::kPartEnergy * parts + at] = part.energy;
  }
}

Range domain(const Model& model) {
  return {.x = model.grid.nx, .y = piece_rows(model.grid), .cloth = 0, .offset = 0};
}

}  // namespace

const Pass watch{
    .name = "watch",
    .about = "divergence: the fastest particle and the kinetic energy, piece by piece",
    .domain = domain,
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
};

}  // namespace weft
