// Separable Catmull–Rom interpolation over the grid, and the pins' exact places.
#include "model/carry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace weft {
namespace {

using Field = std::vector<glm::dvec3>;

/// The four taps around a place on a line of `count` samples. Beyond the ends the line goes on straight.
struct Taps {
  std::uint32_t index[4];
  double weight[4];
};

void add_tap(Taps& taps, int slot, std::int64_t index, double weight, std::int64_t count) {
  if (index >= 0 && index < count) {
    taps.index[slot] = static_cast<std::uint32_t>(index);
    taps.weight[slot] += weight;
    return;
  }
  // p(-1) = 2 p(0) − p(1), and likewise at the other end: the neighbours in slots next to this one.
  const int inward = index < 0 ? 1 : -1;
  taps.index[slot] = taps.index[slot + inward];
  taps.weight[slot + inward] += 2.0 * weight;
  taps.weight[slot + 2 * inward] -= weight;
}

/// Catmull–Rom (Catmull and Rom 1974): through the samples, with continuous slope.
Taps taps_at(double place, std::uint32_t count) {
  const std::int64_t cell =
      std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(place)), 0, std::int64_t{count} - 2);
  const double t = place - static_cast<double>(cell);
  const double weight[4] = {0.5 * t * (t * (2.0 - t) - 1.0), 0.5 * (t * t * (3.0 * t - 5.0) + 2.0),
                            0.5 * t * (t * (4.0 - 3.0 * t) + 1.0), 0.5 * t * t * (t - 1.0)};
  Taps taps{};
  for (const int slot : {1, 2, 0, 3}) add_tap(taps, slot, cell + slot - 1, weight[slot], count);
  return taps;
}

std::vector<Taps> all_taps(std::uint32_t from, std::uint32_t to) {
  std::vector<Taps> taps(to);
  for (std::uint32_t i = 0; i < to; ++i)
    taps[i] = taps_at(static_cast<double>(i) * (from - 1) / (to - 1), from);
  return taps;
}

glm::dvec3 blend(const Taps& taps, const glm::dvec3* samples, std::size_t stride) {
  glm::dvec3 sum = taps.weight[0] * samples[taps.index[0] * stride];
  for (int k = 1; k < 4; ++k) sum += taps.weight[k] * samples[taps.index[k] * stride];
  return sum;
}

/// Cloth by cloth; a cloth that `from` has not got is zero.
Field resample(const Field& field, const Grid& from, const Grid& to) {
  const std::vector<Taps> along_i = all_taps(from.nx, to.nx), along_j = all_taps(from.ny, to.ny);
  Field rows(std::size_t{to.nx} * from.ny);
  Field result(to.count(), glm::dvec3(0.0));
  for (std::uint32_t cloth = 0; cloth < std::min(from.cloths, to.cloths); ++cloth) {
    for (std::uint32_t j = 0; j < from.ny; ++j)
      for (std::uint32_t i = 0; i < to.nx; ++i)
        rows[std::size_t{j} * to.nx + i] = blend(along_i[i], &field[from.index(0, cloth * from.ny + j)], 1);
    for (std::uint32_t j = 0; j < to.ny; ++j)
      for (std::uint32_t i = 0; i < to.nx; ++i)
        result[to.index(i, cloth * to.ny + j)] = blend(along_j[j], &rows[i], to.nx);
  }
  return result;
}

std::vector<std::uint32_t> pinned(const Model& model, double time_s) {
  std::vector<std::uint32_t> list;
  for (std::uint32_t p = 0; p < model.grid.count(); ++p)
    if (model.inverse_mass_at(p, time_s) == 0.0) list.push_back(p);
  return list;
}

/// x and y on the flat cloth, and which cloth, which is farther from any other than a pin reaches.
glm::dvec3 fraction(const Grid& grid, std::uint32_t particle) {
  const std::uint32_t row = particle / grid.nx, cloth = row / grid.ny;
  return {static_cast<double>(particle % grid.nx) / (grid.nx - 1),
          static_cast<double>(grid.own_row(row)) / (grid.ny - 1), 4.0 * cloth};
}

/// The pinned particle of `from` nearest on the flat cloth, if one is within a cell of either grid (or the
/// same pin's radius): further away it is another pin.
std::uint32_t nearest(const std::vector<std::uint32_t>& candidates, const Grid& grid, glm::dvec3 place,
                      double reach) {
  std::uint32_t best = std::numeric_limits<std::uint32_t>::max();
  double best_distance = reach * reach;
  for (const std::uint32_t candidate : candidates) {
    const glm::dvec3 apart = fraction(grid, candidate) - place;
    const double distance = apart.x * apart.x + apart.y * apart.y + apart.z * apart.z;
    if (distance > best_distance) continue;
    best = candidate;
    best_distance = distance;
  }
  return best;
}

bool same_grid(const Grid& a, const Grid& b) { return a.nx == b.nx && a.ny == b.ny && a.cloths == b.cloths; }

}  // namespace

State carry_state(const Model& from, const State& state, const Model& to) {
  const State start_from = start_state(from), start_to = start_state(to);
  const bool copy = same_grid(from.grid, to.grid) && start_from.position == start_to.position;
  State next{.position = state.position, .velocity = state.velocity, .time_s = state.time_s};
  Field displacement(from.grid.count());
  for (std::size_t p = 0; p < displacement.size(); ++p)
    displacement[p] = state.position[p] - start_from.position[p];
  if (same_grid(from.grid, to.grid)) next.broken_links = state.broken_links;
  if (!copy) {
    next.position = start_to.position;
    const Field moved = resample(displacement, from.grid, to.grid);
    for (std::size_t p = 0; p < moved.size(); ++p) next.position[p] += moved[p];
    next.velocity = resample(state.velocity, from.grid, to.grid);
  }
  const std::vector<std::uint32_t> held = pinned(from, state.time_s);
  const double reach = 1.5 * std::max(1.0 / (from.grid.nx - 1), 1.0 / (to.grid.nx - 1));
  for (const std::uint32_t p : pinned(to, state.time_s)) {
    next.velocity[p] = glm::dvec3(0.0);
    if (copy) continue;
    const std::uint32_t old = nearest(held, from.grid, fraction(to.grid, p), reach);
    if (old != std::numeric_limits<std::uint32_t>::max())
      next.position[p] = start_to.position[p] + displacement[old];
  }
  place_moved_pins(to, next);
  return next;
}

}  // namespace weft
