// What spread_look says of a cloth holds: where it is spread by a margin the passes of self-collision find
// nothing, and what it says of edges and speeds is what there is.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "passes/passes.h"
#include "passes/spread.h"
#include "plan/spread_bound.h"
#include "plan/spread_words.h"
#include "solvers/solver.h"
#include "support/shapes.h"

namespace weft {
namespace {

std::uint64_t entries_listed(const Model& model, HostBuffers<float> buffers) {
  for (const Pass* pass : {&carry, &pair_check, &cell_count, &cell_scan, &cell_fill, &cell_sort, &patch_near,
                           &pair_gather, &surface_gather})
    run_mirror(*pass, model, buffers);
  std::uint64_t entries = buffers.words_of(BufferId::collision_state)[shared::kPairsDropped];
  for (const BufferId id : {BufferId::pair_count, BufferId::surface_count})
    for (const std::uint32_t count : buffers.words_of(id)) entries += count;
  return entries;
}

std::vector<Shape> spread_and_not() {
  std::vector<Shape> all = shapes();
  for (const double turn : {0.02, 0.05, 0.08, 0.12})
    for (const double noise : {0.0, 0.01, 0.04}) all.push_back(rolled(turn, noise));
  for (const double shear : {-0.3, 0.3, 0.5}) all.push_back(drawn(1.0, 1.0, shear, 0.01));
  for (const double depth : {0.1, 0.3, 0.5}) all.push_back(creased(depth, 0.01));
  return all;
}

/// Moves every particle so that no edge changes by more than the margin.
void stir(const Model& model, double margin, std::mt19937_64& random, HostBuffers<float>& buffers) {
  std::normal_distribution<float> normal;
  const auto most = static_cast<float>(0.5 * margin * model.grid.spacing_m);
  for (glm::vec4& x : buffers[BufferId::position])
    x += glm::vec4(most * glm::normalize(glm::vec3(normal(random), normal(random), normal(random))), 0.0f);
}

TEST(SpreadLook, SaysSpreadOnlyWhereNothingIsListed) {
  int spread = 0, folded = 0;
  std::uint64_t seed = 0;
  std::mt19937_64 random(7);
  for (const auto& [columns, rows] : std::vector<std::pair<int, int>>{{2, 2}, {3, 9}, {17, 18}, {33, 21}})
    for (const double thickness_cells : {0.2, 1.0}) {
      const Model model = sheet_model(columns, rows, thickness_cells);
      const Plan plan = compile_plan(model, find_solver("leapfrog"));
      ASSERT_TRUE(plan.spreads);
      for (const Shape& shape : spread_and_not()) {
        HostBuffers<float> buffers = buffers_of(model, plan, shape, ++seed);
        ask_for_spread(plan, model, buffers);
        run_mirror(spread_look, model, buffers);
        const auto words = buffers.words_of(BufferId::spread_state);
        const double longest_m = SpreadBound::kLongestEdge * model.grid.spacing_m;
        if (std::bit_cast<float>(words[shared::kSpreadLongest2]) > longest_m * longest_m) continue;
        for (std::uint32_t k = 0; k < shared::kSpreadMargins; ++k) {
          const bool is = (words[shared::kSpreadShort] >> k & 1u) == 0;
          (is ? spread : folded) += 1;
          for (int way = 0; is && way < 4; ++way) {
            HostBuffers<float> stirred = buffers;
            if (way > 0) stir(model, SpreadBound::kMargins[k], random, stirred);
            EXPECT_EQ(entries_listed(model, stirred), 0u)
                << columns << " x " << rows << ", " << thickness_cells << ", " << shape.name << ", margin "
                << k;
          }
        }
      }
    }
  EXPECT_GT(spread, 100);
  EXPECT_GT(folded, 100);
}

// Looks add up to the worst of all.
TEST(SpreadLook, KeepsTheLargestOfAllLooks) {
  const Model model = sheet_model(17, 18, 0.2);
  const Plan plan = compile_plan(model, find_solver("leapfrog"));
  HostBuffers<float> fast = buffers_of(model, plan, rolled(0.02, 0.0), 1);
  for (glm::vec4& v : fast[BufferId::velocity]) v = glm::vec4(0.0f, 3.0f, 0.0f, 0.0f);
  fast[BufferId::velocity][40].y = 3.5f;
  ask_for_spread(plan, model, fast);
  put_spread_vector(fast.words_of(BufferId::spread_state), shared::kSpreadShared,
                    glm::vec3(0.0f, 3.0f, 0.0f));
  run_mirror(spread_look, model, fast);
  const auto found = fast.words_of(BufferId::spread_state);
  EXPECT_EQ(std::bit_cast<float>(found[shared::kSpreadApart2]), 0.25f);
  EXPECT_EQ(std::bit_cast<float>(found[shared::kSpreadSpeed2]), 0.25f);
  EXPECT_NEAR(std::bit_cast<float>(found[shared::kSpreadKick2]), 0.35f * 0.35f, 1e-6f);
  for (glm::vec4& v : fast[BufferId::velocity]) v = glm::vec4(0.0f, 3.0f, 0.0f, 0.0f);
  run_mirror(spread_look, model, fast);
  EXPECT_EQ(fast.words_of(BufferId::spread_state)[shared::kSpreadApart2], found[shared::kSpreadApart2]);
}

// No number is no proof.
TEST(SpreadLook, FailsByEveryMarginWhereSomethingIsNoNumber) {
  const Model model = sheet_model(9, 9, 0.2);
  const Plan plan = compile_plan(model, find_solver("leapfrog"));
  constexpr std::uint32_t kAll = (1u << shared::kSpreadMargins) - 1;
  const HostBuffers<float> flat = buffers_of(model, plan, rolled(0.0, 0.0), 1);
  const auto fails = [&](HostBuffers<float> buffers) {
    ask_for_spread(plan, model, buffers);
    run_mirror(spread_look, model, buffers);
    return buffers.words_of(BufferId::spread_state)[shared::kSpreadShort];
  };
  EXPECT_EQ(fails(flat), 0u);
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e30f})
    for (const BufferId id : {BufferId::position, BufferId::velocity}) {
      HostBuffers<float> broken = flat;
      broken[id][40].z = bad;
      EXPECT_EQ(fails(broken), kAll) << bad << " in " << row_of(id).name;
    }
}

// Whoever changes by more than allowed is told of, by a pass that the host has asked.
TEST(SpreadTeller, TellsWhoseVelocityChangedByMore) {
  HostWords words;
  auto& state = words.words_of(BufferId::spread_state);
  state.assign(shared::kSpreadStateWords, 0u);
  const glm::vec3 here(0.0f), still(0.0f);
  const auto tells = [&](float most, const glm::vec3& v1, const glm::vec3& x1, bool touches) {
    state[shared::kSpreadKicked] = 0;
    state[shared::kSpreadKickMost2] = std::bit_cast<std::uint32_t>(most * most);
    { SpreadTeller<float>(words, 0.01f, touches).look(here, still, x1, v1); }
    return state[shared::kSpreadKicked] != 0;
  };
  EXPECT_FALSE(tells(0.5f, {0.5f, 0.0f, 0.0f}, here, false));
  EXPECT_TRUE(tells(0.5f, {0.51f, 0.0f, 0.0f}, here, false));
  EXPECT_FALSE(tells(0.5f, still, {0.01f, 0.0f, 0.0f}, false)) << "nothing but drift moves it";
  EXPECT_TRUE(tells(0.5f, still, {0.01f, 0.0f, 0.0f}, true)) << "put out of a body by two times the way";
  EXPECT_FALSE(tells(0.5f, still, {0.004f, 0.0f, 0.0f}, true));
  EXPECT_TRUE(tells(0.5f, {std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f}, here, false));
  EXPECT_FALSE(tells(0.0f, {9.0f, 0.0f, 0.0f}, here, true)) << "nobody asked";
}

}  // namespace
}  // namespace weft
