// The box round all bodies, and how far beyond them it goes.
#include "passes/reach.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "model/distance_grid.h"
#include "passes/strain_limit.h"

namespace weft {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Cloth that is faster than this counts as near wherever it is [m/s].
constexpr double kLeapSpeed_m_s = 64.0;

/// Of lengths and places: many times what contact in float loses on the way to a distance.
constexpr double kRounding = 1e-5;

/// A body's extent in its own frame: a box about a point of it, with a rounding.
struct Extent {
  glm::dvec3 middle, half;
  double rounding;
};

/// The part of the box round one body.
void include(const SolidRow<double>& body, const Extent& extent, ReachRow<double>& reach) {
  double turn2 = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec3 moved = body.axes[axis] - body.start_axes[axis];
    turn2 += glm::dot(moved, moved);
  }
  const double turn = std::sqrt(turn2) + kRounding;
  const double travel = 1.001 * std::sqrt(3.0) * reach.leap + glm::length(body.center - body.start);
  const double own = glm::length(extent.middle) + glm::length(extent.half) + extent.rounding;
  if (!(turn < 0.5)) {  // so fast a turn leaves nothing out of reach
    reach.low = glm::dvec3(-kInfinite);
    reach.high = glm::dvec3(kInfinite);
    return;
  }
  const double farthest = (own + (1.0 + turn) * travel) / (1.0 - turn);
  const double place = glm::length(body.center) + glm::length(body.start);
  const double beyond = turn * (farthest + travel) + travel + kRounding * (place + farthest);
  glm::dvec3 middle = body.center, half(extent.rounding + beyond);
  for (int axis = 0; axis < 3; ++axis) {
    middle += extent.middle[axis] * body.axes[axis];
    half += extent.half[axis] * glm::abs(body.axes[axis]);
  }
  reach.low = glm::min(reach.low, middle - half);
  reach.high = glm::max(reach.high, middle + half);
}

/// Half the way from rest to the limit, and a quarter of it for each end of a link in one drift.
void include_links(const Model& model, ReachRow<double>& reach) {
  const double strain = limiting_strain(model);
  const auto longest2 = [&](SpringName name) {
    return std::pow(model.springs[name].rest_m * (1.0 + 0.5 * strain) * (1.0 - kRounding), 2);
  };
  reach.link2 = longest2(kStructuralI);
  reach.diagonal2 = longest2(kShearDown);
  reach.step2 = std::pow(model.springs[kStructuralI].rest_m * 0.25 * strain * (1.0 - kRounding), 2);
}

}  // namespace

bool asks_bodies(const Model& model) {
  return (solid_count(model) > 0 || !model.meshes.empty()) && !has_tilted_floor(model);
}

bool asks_links(const Model& model) {
  return (has_strain_limit(model) || model.scene.tearing) && model.springs[kShearDown].stiffness_n_m > 0.0 &&
         model.moved_pins.empty() && !has_tilted_floor(model);
}

ReachRow<double> reach_row_exact(const Model& model, const KickDrift& row) {
  ReachRow<double> reach{
      glm::dvec3(kInfinite), glm::dvec3(-kInfinite), kInfinite, kInfinite, kInfinite, kInfinite};
  if (!(row.drift_s > 0.0)) return reach;
  if (asks_links(model)) include_links(model, reach);
  if (!asks_bodies(model)) return reach;
  reach.leap = kLeapSpeed_m_s * row.drift_s;
  const SubstepRow<double> bodies = substep_row_exact(model, row);
  for (const SolidRow<double>& solid : bodies.solids)
    include(solid, {glm::dvec3(0.0), solid.half, solid.reach}, reach);
  for (std::size_t m = 0; m < bodies.meshes.size(); ++m) {
    const DistanceGrid& grid = *model.meshes[m];
    const glm::dvec3 half = 0.5 * grid.cell_m * glm::dvec3(grid.samples - 1u);
    include(bodies.meshes[m], {grid.low_m + half, half, 0.0}, reach);
  }
  return reach;
}

std::vector<std::uint32_t> initial_reach_groups(const Model& model, bool links) {
  const Grid& grid = model.grid;
  const std::uint32_t down = grid.cloths * ((grid.ny + 1) / 2);
  std::vector<std::uint32_t> words{0, grid.rows(), 1,    0, grid.rows(),    1, 0, grid.rows(),
                                   1, 0,           down, 1, links ? 1u : 0u};
  if (model.scene.tearing) words.insert(words.end(), {0, grid.rows(), 1, 0, grid.rows(), 1});
  return words;
}

void tell_torn(const Grid& grid, std::span<const std::uint32_t> broken_links,
               std::vector<std::uint32_t>& words) {
  const bool torn = std::ranges::any_of(broken_links, [](std::uint32_t links) { return links != 0; });
  words[shared::kReachTorn] = torn ? (grid.nx + shared::kReachGroup - 1) / shared::kReachGroup : 0;
}

bool is_torn(const Model& model, const HostWords& buffers) {
  if (!model.scene.tearing) return false;
  const auto& words = buffers.words_of(BufferId::reach_groups);
  return words.empty() || words[shared::kReachTorn] != 0;
}

bool take_reach(const Model& model, HostWords& buffers, std::uint32_t word) {
  auto& words = buffers.words_of(BufferId::reach_groups);
  return words.empty() || !asks_bodies(model) || std::exchange(words[word], 0u) != 0;
}

bool take_tear(HostWords& buffers) {
  auto& words = buffers.words_of(BufferId::reach_groups);
  if (words.empty()) return true;
  const bool asked = std::exchange(words[shared::kReachTear], 0u) != 0;
  return asked || words[shared::kReachAsksLinks] == 0;
}

bool take_links(HostWords& buffers, std::uint32_t item) {
  auto& words = buffers.words_of(BufferId::reach_groups);
  if (words.empty() || words[shared::kReachAsksLinks] == 0) return true;
  std::uint32_t& groups = words[reach_word_of_colour(item)];
  const bool last = item == 2 * kStructuralJ + 1 || item + 1 == kNearSpringColours;
  return (last ? std::exchange(groups, 0u) : groups) != 0;
}

}  // namespace weft
