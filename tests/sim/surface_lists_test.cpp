// The lists of self-collision hold what all pairs, tried one by one, say: neither the grid of patches nor the
// tests that pass over what is nearly flat leave anything out, and nothing is listed twice.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <random>
#include <set>

#include "passes/passes.h"
#include "passes/patches.h"
#include "passes/surface.h"
#include "passes/tables.h"
#include "plan/plan.h"
#include "scenes.h"
#include "solvers/solver.h"

namespace weft::test {
namespace {

using Corners = std::vector<std::uint32_t>;      // ascending
using Primitives = std::pair<Corners, Corners>;  // the first has no more corners
using Listed = std::map<Primitives, int>;        // how often
using Positions = std::vector<glm::vec<4, float>>;

Corners sorted(Corners corners) {
  std::ranges::sort(corners);
  return corners;
}

Primitives primitives_of(const SurfacePair<float>& pair) {
  const auto& p = pair.particle;
  if (!pair.edges) return {{p[0]}, sorted({p[1], p[2], p[3]})};
  const Corners a = sorted({p[0], p[1]}), b = sorted({p[2], p[3]});
  return {std::min(a, b), std::max(a, b)};
}

/// Edges and triangles of the cloth, each once.
std::set<Corners> mesh_of(const Grid& grid, std::size_t corners) {
  std::set<Corners> found;
  for (std::uint32_t p = 0; p < grid.count(); ++p)
    for (std::size_t k = 0; k < 6; ++k) {
      const auto b = ring_particle(grid, p, k), c = ring_particle(grid, p, k + 1);
      if (corners == 2 && b) found.insert(sorted({p, *b}));
      if (corners == 3 && b && c) found.insert(sorted({p, *b, *c}));
    }
  return found;
}

bool apart(const Corners& a, const Corners& b) {
  return std::ranges::none_of(a, [&](std::uint32_t p) { return std::ranges::count(b, p) != 0; });
}

/// Calls visit(primitives, squared distance) for all that have no particle in common. In double: the lists,
/// in float, look at the same two from other corners.
template <class Visit>
void each_by_each(const Grid& grid, const Positions& at, Visit&& visit) {
  const std::vector<glm::dvec4> x(at.begin(), at.end());
  const auto triangles = mesh_of(grid, 3), edges = mesh_of(grid, 2);
  for (std::uint32_t p = 0; p < grid.count(); ++p)
    for (const Corners& t : triangles)
      if (apart({p}, t)) visit({{p}, t}, particle_and_triangle<double>(x, {p, t[0], t[1], t[2]}).squared);
  for (auto a = edges.begin(); a != edges.end(); ++a)
    for (auto b = std::next(a); b != edges.end(); ++b)
      if (apart(*a, *b))
        visit({*a, *b}, edge_and_edge<double>(x, {(*a)[0], (*a)[1], (*b)[0], (*b)[1]}).squared);
}

struct Lists {
  Listed surfaces;
  std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
  std::uint32_t dropped;
  std::size_t patches_listed, patches;
};

/// What the mirrors list of a state.
Lists lists_of(const Model& model, const State& state, Positions& x) {
  const Plan plan = compile_plan(model, find_solver("leapfrog"));
  HostBuffers<float> buffers;
  size_buffers(plan, model, buffers);
  load_state(model, state, buffers);
  const KickDrift row{};
  for (const Pass* pass : {&carry, &pair_check, &cell_count, &cell_scan, &cell_fill, &cell_sort, &patch_near,
                           &pair_gather, &surface_gather}) {
    const Constants constants = pass->constants(model);
    pass->mirror_f32({.model = model, .constants = constants, .row = row}, buffers);
  }
  const CollisionView<float> view(model);
  x = buffers[BufferId::position];
  buffers[BufferId::near_position] = x;
  const auto& asked = buffers.words_of(BufferId::patch_listed);
  Lists lists{{},
              {},
              buffers.words_of(BufferId::collision_state)[shared::kPairsDropped],
              static_cast<std::size_t>(std::ranges::count_if(asked, [](std::uint32_t w) { return w != 0; })),
              asked.size()};
  for_each_surface_pair(view, buffers,
                        [&](const SurfacePair<float>& pair) { ++lists.surfaces[primitives_of(pair)]; });
  for (std::uint32_t p = 0; p < model.grid.count(); ++p)
    for (std::size_t k = 0; k < buffers.words_of(BufferId::pair_count)[p]; ++k)
      lists.pairs.insert(
          {p, view.particle_at(buffers.words_of(BufferId::pair_places)[k * model.grid.count() + p])});
  return lists;
}

/// Whether `listed` is right for a squared distance: within rounding of the reach both are.
bool is_right(bool listed, double squared, float reach_squared) {
  return listed ? squared < reach_squared * 1.0001 : squared > reach_squared * 0.9999;
}

/// Where lists are full, what is in them must be right.
/// @return whether none was
bool expect_all_listed(const Model& model, const State& state, const std::string& name) {
  Positions x;
  const Lists lists = lists_of(model, state, x);
  const CollisionView<float> view(model);
  const bool room = lists.dropped == 0;
  std::size_t wrong = 0;
  each_by_each(model.grid, x, [&](const Primitives& pair, double squared) {
    const auto at = lists.surfaces.find(pair);
    const bool listed = at != lists.surfaces.end();
    if (listed && at->second != 1) ++wrong;
    if ((listed || room) && !is_right(listed, squared, view.surface_reach_squared)) ++wrong;
  });
  EXPECT_EQ(wrong, 0u) << name << ": surfaces of " << lists.surfaces.size();
  wrong = 0;
  for (std::uint32_t a = 0; a < model.grid.count(); ++a)
    for (std::uint32_t b = 0; b < model.grid.count(); ++b) {
      if (beside(model.grid, a, b)) continue;
      const bool listed = lists.pairs.contains({a, b});
      if ((listed || room) && !is_right(listed, squared_distance(x[a], x[b]), view.limit(a, b).reach_squared))
        ++wrong;
    }
  EXPECT_EQ(wrong, 0u) << name << ": pairs of " << lists.pairs.size();
  return room;
}

Model crumpled_model(double thickness_cells, int cloths) {
  std::string more;
  for (int k = 1; k < cloths; ++k) more += "[[cloths]]\ncenter = [0.0, 0.0, 0.11]\n";
  return build_model(parse_scene(fmt::format("[cloth]\nwidth = 1.3\nheight = 1.1\nresolution = 14\n{}"
                                             "[self_collision]\nthickness = {}\n",
                                             more, thickness_cells * 0.1),
                                 "lists.toml")
                         .scene);
}

/// The cloth rolled up along i by `turn` [rad] a cell, a tenth of a cell on a cell, so that it does not come
/// back to where it was; with random noise, in cells.
State rolled(const Model& model, double turn, double noise, std::uint64_t seed) {
  State state = start_state(model);
  std::mt19937_64 random(seed);
  const double a = model.grid.spacing_m;
  std::normal_distribution<double> normal(0.0, noise * a);
  for (std::uint32_t j = 0; j < model.grid.rows(); ++j) {
    glm::dvec2 at(0.0);
    for (std::uint32_t i = 0; i < model.grid.nx; ++i) {
      glm::dvec3& x = state.position[model.grid.index(i, j)];
      x = {at.x + normal(random), x.y + normal(random), x.z + at.y + normal(random)};
      at += a * glm::dvec2(std::cos(turn * i) + 0.1, std::sin(turn * i));
    }
  }
  return state;
}

// Flat, curved, rolled up, wrinkled and crushed; one cloth and two.
TEST(SurfaceLists, HoldWhatAllPairsOneByOneSay) {
  std::uint64_t seed = 1;
  int whole = 0;
  for (const int cloths : {1, 2})
    for (const double thickness : {0.1, 0.9}) {
      if (cloths == 2 && thickness < 0.5) continue;
      const Model model = crumpled_model(thickness, cloths);
      for (const double turn : {0.0, 0.2, 0.6, 1.1, 2.2})
        for (const double noise : {0.0, 0.08, 0.25})
          whole += expect_all_listed(
              model, rolled(model, turn, noise, ++seed),
              fmt::format("{} cloths, thickness {}, turn {}, noise {}", cloths, thickness, turn, noise));
    }
  EXPECT_GE(whole, 30) << "of 45 have room for all";
}

// As thick as several cells, where neighbours' neighbours are within reach already: one that is flat or
// bends.
TEST(SurfaceLists, HoldThePairsOfThickCloth) {
  const Model model = crumpled_model(2.5, 1);
  for (const double turn : {0.0, 0.2, 0.4})
    for (const double noise : {0.0, 0.08})
      EXPECT_TRUE(expect_all_listed(model, rolled(model, turn, noise, 5),
                                    fmt::format("turn {}, noise {}", turn, noise)));
}

/// The cloth folded by `angle` [rad] about a line along the cells' diagonals.
State folded_along_diagonals(const Model& model, double angle, double noise, std::uint64_t seed) {
  State state = start_state(model);
  std::mt19937_64 random(seed);
  const double a = model.grid.spacing_m;
  std::normal_distribution<double> normal(0.0, noise * a);
  const glm::dvec3 along =
      glm::normalize(state.position[model.grid.index(1, 0)] - state.position[model.grid.index(0, 1)]);
  const glm::dvec3 line = state.position[model.grid.index(model.grid.nx / 2, model.grid.ny / 2)];
  for (std::uint32_t j = 0; j < model.grid.rows(); ++j)
    for (std::uint32_t i = 0; i < model.grid.nx; ++i) {
      glm::dvec3& x = state.position[model.grid.index(i, j)];
      if (i + j > model.grid.nx / 2 + model.grid.ny / 2) {
        const glm::dvec3 arm = x - line, across = arm - glm::dot(arm, along) * along;
        x = line + (arm - across) + std::cos(angle) * across + std::sin(angle) * glm::cross(along, across);
      }
      x += glm::dvec3(normal(random), normal(random), normal(random));
    }
  return state;
}

// A sharp crease along the diagonals brings what meets at one of them within reach: 0.707 cells apart on the
// cloth, at 0.55 from a fold of 102 degrees on.
TEST(SurfaceLists, HoldWhatACreaseAlongTheDiagonalsBringsNear) {
  const Model model = crumpled_model(0.1, 1);
  for (const double angle : {0.5, 1.7, 1.9, 2.4, 2.9})
    for (const double noise : {0.0, 0.02, 0.08})
      expect_all_listed(model, folded_along_diagonals(model, angle, noise, 11),
                        fmt::format("folded by {}, noise {}", angle, noise));
  Positions x;
  EXPECT_TRUE(lists_of(model, folded_along_diagonals(model, 0.5, 0.0, 1), x).surfaces.empty());
  EXPECT_FALSE(lists_of(model, folded_along_diagonals(model, 2.4, 0.0, 1), x).surfaces.empty());
}

/// A cloth of any size, thickness and number.
Model any_model(std::mt19937_64& random) {
  const auto whole = [&](int least, int most) { return std::uniform_int_distribution(least, most)(random); };
  const int nx = whole(2, 12), ny = whole(2, 12);
  std::string more;
  for (int k = whole(0, 2); k > 0; --k)
    more += fmt::format("[[cloths]]\ncenter = [0.0, 0.0, {}]\n", 0.11 * k);
  const double cells = std::exp(std::uniform_real_distribution(std::log(0.05), std::log(2.5))(random));
  return build_model(parse_scene(fmt::format("[cloth]\nwidth = {}\nheight = {}\nresolution = {}\n{}"
                                             "[self_collision]\nthickness = {}\n",
                                             0.1 * (nx - 1), 0.1 * (ny - 1), nx, more, 0.1 * cells),
                                 "any.toml")
                         .scene);
}

/// Rolled up, folded about any line, in pleats, waved, flattened, stretched or thrown into a heap, with noise
/// or none, and here and there a particle that is far from its own or lies on another.
State any_state(const Model& model, std::mt19937_64& random) {
  const auto real = [&](double least, double most) {
    return std::uniform_real_distribution(least, most)(random);
  };
  const auto whole = [&](int least, int most) { return std::uniform_int_distribution(least, most)(random); };
  const double a = model.grid.spacing_m;
  State state = rolled(model, whole(0, 1) * real(0.0, 3.2), 0.0, 0);
  if (whole(0, 2) == 0) {  // a fold, in the plane of the start
    const double way = real(0.0, 6.3), angle = real(0.0, 3.14);
    const glm::dvec3 across{std::cos(way), std::sin(way), 0.0}, along{-across.y, across.x, 0.0};
    const glm::dvec3 line = state.position[model.grid.count() / 2] + real(-1.0, 1.0) * a * across;
    for (glm::dvec3& x : state.position)
      if (const double arm = glm::dot(x - line, across); arm > 0.0)
        x += arm * ((std::cos(angle) - 1.0) * across + std::sin(angle) * glm::cross(along, across));
  }
  const glm::dvec3 wave{real(-40.0, 40.0), real(-40.0, 40.0), 0.0};
  const double height_m = whole(0, 1) * real(0.0, 3.0) * a;
  glm::dvec3 scale{1.0};
  if (whole(0, 2) == 0)
    for (int axis = 0; axis < 3; ++axis)
      scale[axis] = std::array{0.0, 0.1, 0.5, 1.0, 3.0, 20.0}[static_cast<std::size_t>(whole(0, 5))];
  const double heap = whole(0, 7) == 0 ? 0.0 : 1.0, noise_m = whole(0, 2) * real(0.0, 0.2) * a;
  std::normal_distribution<double> normal;
  for (glm::dvec3& x : state.position) {
    x.z += height_m * std::sin(glm::dot(wave, x));
    x = scale * heap * x +
        (heap == 0.0 ? 2.0 * a : noise_m) * glm::dvec3(normal(random), normal(random), normal(random));
  }
  const auto any = [&] {
    return static_cast<std::size_t>(whole(0, static_cast<int>(model.grid.count()) - 1));
  };
  for (int k = whole(-3, 3); k > 0; --k) state.position[any()] = state.position[any()];
  for (int k = whole(-3, 2); k > 0; --k)
    state.position[any()] += a * real(0.0, 30.0) * glm::dvec3(normal(random), normal(random), 1.0);
  return state;
}

// Cloths of two columns and of many, of one row of patches and of odd ones, next to each other in memory;
// with edges and triangles that have become points and lines.
TEST(SurfaceLists, HoldWhatAnyShapeBringsNear) {
  constexpr unsigned kShapes = 60;
  unsigned whole = 0;
  for (unsigned seed = 0; seed < kShapes; ++seed) {
    std::mt19937_64 random(seed);
    const Model model = any_model(random);
    const Grid& grid = model.grid;
    whole += expect_all_listed(model, any_state(model, random),
                               fmt::format("seed {}, {} x {} x {}", seed, grid.nx, grid.ny, grid.cloths));
  }
  EXPECT_GE(whole, kShapes / 2) << "have room for all";
}

// Two corners of a triangle on each other leave an edge, and all three a point: its distance is that of the
// edge's nearest point, and no number is lost in a division by the length that is gone.
TEST(SurfaceLists, ATriangleWithCornersOnEachOtherIsAnEdge) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<float> real(-1.0f, 1.0f);
  const auto any = [&] { return glm::vec3(real(random), real(random), real(random)); };
  for (int k = 0; k < 1000; ++k) {
    const bool point = k % 10 == 0;
    const glm::vec3 p = any(), a = any(), b = point ? a : any(), e = b - a;
    const float t = point ? 0.0f : std::clamp(glm::dot(p - a, e) / glm::dot(e, e), 0.0f, 1.0f);
    const float expected = glm::distance(p, a + t * e);
    for (const std::array<glm::vec3, 3>& corner : {std::array{a, a, b}, {a, b, a}, {b, a, a}}) {
      const glm::vec3 weight = nearest_in_triangle(p, corner);
      const glm::vec3 nearest = weight.x * corner[0] + weight.y * corner[1] + weight.z * corner[2];
      ASSERT_NEAR(glm::distance(p, nearest), expected, 1e-5f) << k;
    }
  }
}

// Why Folds looks at diagonals by themselves: on the flat cloth all else that has no particle in common is at
// least a cell apart.
TEST(SurfaceLists, OnlyWhatMeetsAtADiagonalIsLessThanACellApart) {
  const Model model = crumpled_model(0.1, 1);
  const Grid& grid = model.grid;
  Positions x;
  for (const glm::dvec3& at : start_state(model).position) x.emplace_back(glm::vec3(at), 1.0f);
  std::set<Primitives> at_diagonals;
  for (std::uint32_t j = 0; j + 1 < grid.ny; ++j)
    for (std::uint32_t i = 0; i + 1 < grid.nx; ++i) {
      const std::uint32_t here = grid.index(i, j), right = here + 1, below = grid.index(i, j + 1);
      const Corners diagonal = sorted({right, below});
      at_diagonals.insert({{here}, sorted({right, below, below + 1})});
      at_diagonals.insert({{below + 1}, sorted({here, right, below})});
      for (const std::uint32_t corner : {here, below + 1})
        for (std::size_t k = 0; k < 6; ++k)
          if (const auto end = ring_particle(grid, corner, k); end && apart(diagonal, {*end})) {
            const Corners edge = sorted({corner, *end});
            at_diagonals.insert({std::min(diagonal, edge), std::max(diagonal, edge)});
          }
    }
  const auto cell_squared = static_cast<float>(grid.spacing_m * grid.spacing_m);
  std::size_t nearer = 0;
  each_by_each(grid, x, [&](const Primitives& pair, double squared) {
    if (squared > 0.99 * cell_squared) return;
    ++nearer;
    EXPECT_TRUE(at_diagonals.contains(pair)) << "at " << std::sqrt(squared / cell_squared) << " cells";
  });
  EXPECT_EQ(nearer, at_diagonals.size());
}

// What they pass over: nothing is searched in a cloth that is flat, or bends a little, and has nothing near.
TEST(SurfaceLists, SearchNothingWhereTheClothIsNearlyFlat) {
  const Model model = crumpled_model(0.1, 1);
  Positions x;
  for (const double turn : {0.0, 0.2}) {
    const Lists lists = lists_of(model, rolled(model, turn, 0.01, 7), x);
    EXPECT_EQ(lists.patches_listed, 0u) << turn;
    EXPECT_TRUE(lists.surfaces.empty() && lists.pairs.empty());
  }
  EXPECT_EQ(lists_of(model, rolled(model, 2.2, 0.0, 7), x).patches_listed, 7u * 6u) << "all are near others";
}

}  // namespace
}  // namespace weft::test
