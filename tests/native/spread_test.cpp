// What native concludes of a cloth that is spread out over a plane holds: the passes that it leaves out find
// nothing, and end in the same bits (docs/float-form.md "Spread").
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "native/engine.h"
#include "native/features.h"
#include "native/spread_frames.h"
#include "passes/lists.h"
#include "scene/reader.h"
#include "sim/cpu_simulation.h"
#include "sim/native_simulation.h"
#include "solvers/solver.h"
#include "support/shapes.h"

namespace weft {
namespace {

Constants constants_of(const Plan& plan) {
  Constants all;
  for (const PlanStep& step : plan.steps)
    if (step.block == Block::substep) all.insert(all.end(), step.constants.begin(), step.constants.end());
  return all;
}

/// Whether each kernel, and several threads, say that the cloth is spread; all say the same.
bool is_spread(const Model& model, const Plan& plan, const HostBuffers<float>& buffers, double margin,
               SpreadState& found) {
  native::Crew crew(2);
  std::vector<std::pair<bool, SpreadState>> answers;
  for (const native::Kernels* kernels : native::kernels_here())
    for (const std::uint32_t threads : {1u, 3u}) {
      native::Cloth cloth(model, constants_of(plan));
      cloth.take_changes(buffers);
      cloth.load(buffers, 0, cloth.rows());
      SpreadState state;
      const native::SpreadFrames frames(cloth, *kernels, plan, model);
      const bool spread = frames.is_spread_by(margin, state, crew, threads);
      answers.emplace_back(spread, state);
    }
  found = answers[0].second;
  for (const auto& [spread, state] : answers) {
    EXPECT_EQ(spread, answers[0].first);
    EXPECT_EQ(state.apart_m_s, found.apart_m_s);
    EXPECT_EQ(state.speed_m_s, found.speed_m_s);
    EXPECT_EQ(state.place_m, found.place_m);
  }
  return answers[0].first;
}

/// What the passes of self-collision list, and what finds no room.
std::uint64_t entries_listed(const Model& model, HostBuffers<float> buffers) {
  for (const Pass* pass : {&carry, &pair_check, &cell_count, &cell_scan, &cell_fill, &cell_sort, &patch_near,
                           &pair_gather, &surface_gather})
    run_mirror(*pass, model, buffers);
  std::uint64_t entries = buffers.words_of(BufferId::collision_state)[shared::kPairsDropped];
  for (const BufferId id : {BufferId::pair_count, BufferId::surface_count})
    for (const std::uint32_t count : buffers.words_of(id)) entries += count;
  return entries;
}

/// Moves every particle by as much as lets each edge change by the margin: to and fro along the cloth, which
/// shortens every other edge by all of it, or anywhere.
void stir(const Model& model, double margin, int way, std::mt19937_64& random, HostBuffers<float>& buffers) {
  auto& x = buffers[BufferId::position];
  const auto most = static_cast<float>(0.5 * margin * model.grid.spacing_m);
  std::normal_distribution<float> normal;
  const glm::vec3 along = glm::normalize(glm::vec3(x[1] - x[0])),
                  down = glm::normalize(glm::vec3(x[model.grid.nx] - x[0]));
  for (std::uint32_t p = 0; p < x.size(); ++p) {
    const std::uint32_t i = p % model.grid.nx, j = p / model.grid.nx;
    const float sign = (way == 1 ? i : way == 2 ? j : i + j) % 2 == 0 ? 1.0f : -1.0f;
    const glm::vec3 anywhere = glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
    x[p] += glm::vec4(most * (way == 0 ? anywhere : sign * (way == 2 ? down : along)), 0.0f);
  }
}

std::vector<Shape> spread_and_not() {
  std::vector<Shape> all = shapes();
  for (const double turn : {0.02, 0.05, 0.08, 0.12})
    for (const double noise : {0.0, 0.01, 0.04}) all.push_back(rolled(turn, noise));
  for (const double shear : {-0.3, 0.3, 0.5}) all.push_back(drawn(1.0, 1.0, shear, 0.01));
  for (const double depth : {0.1, 0.3, 0.5}) all.push_back(creased(depth, 0.01));
  all.push_back(drawn(0.7, 1.2, 0.0, 0.01));
  all.push_back(drawn(1.9, 0.9, 0.2, 0.01));
  return all;
}

// The law that lets native leave the passes out: where a look says that the cloth is spread by a margin, and
// no edge changes by more, the reference's passes list nothing and lack no room.
TEST(NativeSpread, NothingIsListedWhereItSaysSo) {
  int spread = 0, folded = 0;
  std::uint64_t seed = 0;
  std::mt19937_64 random(5);
  for (const auto& [columns, rows] : std::vector<std::pair<int, int>>{{2, 2}, {3, 9}, {17, 18}, {33, 21}})
    for (const double thickness_cells : {0.2, 1.0}) {
      const Model model = sheet_model(columns, rows, thickness_cells);
      const Plan plan = compile_plan(model, find_solver("leapfrog"));
      for (const Shape& shape : spread_and_not()) {
        SCOPED_TRACE(fmt::format("{} x {}, {}, {}", columns, rows, thickness_cells, shape.name));
        const HostBuffers<float> buffers = buffers_of(model, plan, shape, ++seed);
        for (const double margin : SpreadBound::kMargins) {
          SpreadState found;
          const bool is = is_spread(model, plan, buffers, margin, found);
          (is ? spread : folded) += 1;
          for (int way = 0; is && way < 4; ++way) {
            HostBuffers<float> stirred = buffers;
            stir(model, margin, way, random, stirred);
            ASSERT_EQ(entries_listed(model, std::move(stirred)), 0u) << margin << " " << way;
          }
        }
      }
    }
  EXPECT_GT(spread, 150);  // of 840
  EXPECT_GT(folded, 300);
}

// What it says of motion is what there is.
TEST(NativeSpread, TellsHowTheClothMoves) {
  const Model model = sheet_model(19, 18, 0.4, "[[pins]]\nat = [0.0, 0.0]\n");
  const Plan plan = compile_plan(model, find_solver("leapfrog"));
  HostBuffers<float> buffers = buffers_of(model, plan, rolled(0.03, 0.01), 3);
  std::mt19937_64 random(8);
  std::normal_distribution<float> normal;
  for (glm::vec4& v : buffers[BufferId::velocity]) v = {normal(random), normal(random), normal(random), 0.0f};
  SpreadState found;
  ASSERT_TRUE(is_spread(model, plan, buffers, 0.02, found));
  double apart = 0, speed = 0, place = 0;
  const auto at = [&](BufferId id, std::uint32_t i, std::uint32_t j) {
    return glm::dvec3(buffers[id][model.grid.index(i, j)]);
  };
  for (std::uint32_t j = 0; j < model.grid.ny; ++j)
    for (std::uint32_t i = 0; i < model.grid.nx; ++i) {
      const glm::dvec3 v = at(BufferId::velocity, i, j);
      speed = std::max(speed, glm::length(v));
      place = std::max(place, glm::length(at(BufferId::position, i, j)));
      if (i + 1 < model.grid.nx) apart = std::max(apart, glm::distance(v, at(BufferId::velocity, i + 1, j)));
      if (j + 1 < model.grid.ny) apart = std::max(apart, glm::distance(v, at(BufferId::velocity, i, j + 1)));
    }
  EXPECT_NEAR(found.apart_m_s, apart, 1e-4 * apart);
  EXPECT_NEAR(found.speed_m_s, speed, 1e-4 * speed);
  EXPECT_NEAR(found.place_m, place, 1e-4 * place);
  EXPECT_EQ(found.margin, 0.02);
}

/// Particles in a row that gain speed at random, and what a look at them finds.
struct Row {
  std::vector<glm::dvec3> x, v;
  std::mt19937_64 random;
  double drift_s;

  /// @param speed_m_s   of each by itself
  /// @param shared_m_s  of all
  Row(std::uint64_t seed, double speed_m_s, double shared_m_s, double drift)
      : x(12), v(12), random(seed), drift_s(drift) {
    std::normal_distribution<double> normal;
    for (std::size_t p = 0; p < x.size(); ++p) {
      x[p] = {0.1 * static_cast<double>(p), 0.0, 0.0};
      v[p] = speed_m_s * glm::dvec3(normal(random), normal(random), normal(random));
      v[p].y += shared_m_s;
    }
  }
  double step(double kick_m_s) {
    std::normal_distribution<double> normal;
    double most = 0.0;
    for (std::size_t p = 0; p < x.size(); ++p) {
      const glm::dvec3 kick = kick_m_s * glm::dvec3(normal(random), normal(random), normal(random));
      v[p] += kick;
      x[p] += drift_s * v[p];
      most = std::max(most, glm::length(kick));
    }
    return most;
  }
  SpreadState look(double margin) const {
    SpreadState found{.margin = margin};
    for (std::size_t p = 0; p < x.size(); ++p) {
      found.speed_m_s = std::max(found.speed_m_s, glm::length(v[p]));
      found.place_m = std::max(found.place_m, glm::length(x[p]));
      if (p > 0) found.apart_m_s = std::max(found.apart_m_s, glm::distance(v[p], v[p - 1]));
    }
    return found;
  }
  /// How much any edge is another than in `then`.
  double changed_since(const std::vector<glm::dvec3>& then) const {
    double most = 0.0;
    for (std::size_t p = 1; p < x.size(); ++p)
      most = std::max(most, glm::distance(x[p] - x[p - 1], then[p] - then[p - 1]));
    return most;
  }
};

// The promise of SpreadWatch: where it says so, each state between two looks is within the margin of one of
// them, and no way is longer than what keeps everybody in the lists' room until they are made anew.
TEST(NativeSpread, StatesBetweenLooksAreWithinTheirMargins) {
  const Model model = sheet_model(17, 17, 0.3, "[[pins]]\nat = [0.0, 0.0]\n");
  const Plan plan = compile_plan(model, find_solver("leapfrog"));
  const CollisionLayout layout = collision_layout(model);
  std::uint32_t check = 1, lists = 1;  // every how many substeps
  for (const PlanStep& step : plan.steps) {
    if (step.pass == &pair_check) check = std::max(check, step.interval);
    if (step.pass == &cell_count) lists = std::max(lists, step.interval);
  }
  const double a = model.grid.spacing_m, room_m = (layout.roam_max_m - layout.stale_m) / (check + lists);
  int proven = 0, refused = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> exponent(-3.0, 1.0);
    Row row(seed, std::pow(10.0, exponent(random)), std::pow(10.0, exponent(random) + 1.0), 1e-4);
    SpreadWatch watch(plan, model);
    const double kick_m_s = std::pow(10.0, exponent(random) - 2.0);
    for (int batch = 0; batch < 6; ++batch) {
      const SpreadState begin = row.look(0.08);
      const std::uint32_t substeps = watch.substeps_from(begin, row.drift_s, 256);
      if (substeps == 0) break;
      std::vector<std::vector<glm::dvec3>> states{row.x};
      double kick = 0.0;
      for (std::uint32_t s = 0; s < substeps; ++s) {
        kick = std::max(kick, row.step(kick_m_s));
        states.push_back(row.x);
      }
      const SpreadState end = row.look(0.04);
      const bool is = watch.stayed_spread(begin, end, row.drift_s, substeps, static_cast<float>(kick * kick));
      (is ? proven : refused) += 1;
      if (!is) break;
      for (std::size_t s = 0; s < states.size(); ++s) {
        Row then = row;
        then.x = states[s];
        ASSERT_TRUE(then.changed_since(states.front()) <= 0.08 * a ||
                    then.changed_since(states.back()) <= 0.04 * a)
            << seed << " " << s << " of " << substeps;
        for (std::size_t p = 0; s > 0 && p < row.x.size(); ++p)
          ASSERT_LE(glm::distance(states[s][p], states[s - 1][p]), room_m) << seed;
      }
    }
  }
  EXPECT_GT(proven, 300);
  EXPECT_GT(refused, 20);
}

// A frame in which it cannot be proven is not tried again at once, and ever later.
TEST(NativeSpread, FramesThatFailAreTriedLess) {
  const Model model = sheet_model(9, 9, 0.3);
  SpreadWatch watch(compile_plan(model, find_solver("leapfrog")), model);
  int tries = 0;
  for (int frame = 0; frame < 500; ++frame)
    if (watch.tries_frame()) {
      ++tries;
      watch.end_frame(false);
    }
  EXPECT_GE(tries, 8);
  EXPECT_LE(tries, 16);
}

// A thickness that pairs of a flat cloth nearly keep leaves nothing to conclude from a plane.
TEST(NativeSpread, ThickClothIsNeverSpread) {
  const auto is_possible = [](double thickness_cells) {
    const Model model = sheet_model(9, 9, thickness_cells);
    return SpreadBound(compile_plan(model, find_solver("leapfrog")), model).is_possible();
  };
  EXPECT_TRUE(is_possible(0.5));
  EXPECT_TRUE(is_possible(1.0));
  EXPECT_FALSE(is_possible(3.0));
}

Model scene_of(const std::string& scene, std::vector<std::string> set) {
  return build_model(load_scene(find_scene(scene), {std::move(set)}).scene);
}

void expect_same_state(const State& got, const State& expected) {
  ASSERT_EQ(got.position.size(), expected.position.size());
  for (std::size_t p = 0; p < got.position.size(); ++p) {
    ASSERT_EQ(got.position[p], expected.position[p]) << "position of particle " << p;
    ASSERT_EQ(got.velocity[p], expected.velocity[p]) << "velocity of particle " << p;
  }
}

struct SpreadCase {
  const char* scene;
  std::vector<std::string> set;
  int frames;
  bool stays;  ///< spread, so that lists are made less often
};

// Whole frames: of a cloth that stays spread, of one that falls on a sphere and folds, and of one that a wind
// crumples, so that frames are taken back.
TEST(NativeSpread, FramesEndInTheReferencesBits) {
  const std::vector<SpreadCase> cases{
      {"1", {"cloth.resolution=33", "self_collision.thickness=0.01"}, 20, true},
      {"5", {"cloth.resolution=33", "self_collision.thickness=0.01"}, 40, false},
      {"drape", {"cloth.resolution=24", "self_collision.thickness=0.01"}, 40, false},
      {"3", {"cloth.resolution=33", "self_collision.thickness=0.02", "wind.velocity=[8,0,12]"}, 30, false}};
  for (const SpreadCase& one : cases) {
    const Model model = scene_of(one.scene, one.set);
    const Solver& solver = find_solver("leapfrog");
    const auto right = make_cpu_simulation(model, solver, "f32");
    for (int f = 0; f < one.frames; ++f) right->advance(1.0 / 60.0, right->plan().substeps);
    for (const std::uint32_t threads : {1u, 3u}) {
      SCOPED_TRACE(fmt::format("scene {}, {} threads", one.scene, threads));
      const auto got = make_native_simulation(model, solver, "f32", {.threads = threads});
      std::uint64_t dispatches = 0;
      for (int f = 0; f < one.frames; ++f)
        dispatches = got->advance(1.0 / 60.0, got->plan().substeps).dispatches;
      EXPECT_EQ(dispatches, got->plan().dispatches());
      expect_same_state(got->read(), right->read());
      EXPECT_EQ(got->self_collision()->held_back, right->self_collision()->held_back);
      if (one.stays) {
        EXPECT_EQ(got->self_collision()->lists_built, 20u);
        EXPECT_GT(right->self_collision()->lists_built, 40u);
        EXPECT_EQ(got->self_collision()->spread_frames, 20u);
      } else {
        EXPECT_LE(got->self_collision()->lists_built, right->self_collision()->lists_built);
      }
    }
  }
}

// Frames in slices, and pins that are dragged in the middle of one.
TEST(NativeSpread, SlicesAndDragsEndInTheReferencesBits) {
  const Model model = scene_of("1", {"cloth.resolution=33", "self_collision.thickness=0.01"});
  const Solver& solver = find_solver("leapfrog");
  const auto run = [&](HostSimulation& simulation) {
    for (int f = 0; f < 6; ++f) {
      simulation.begin_frame(1.0 / 60.0, simulation.plan().substeps);
      int slices = 0;
      while (simulation.continue_frame(0.0)) {
        if (++slices != 20 + f || f % 2 == 0) continue;
        const glm::vec3 to(-0.5 + 0.01 * f, 1.3, 0.02 * f);
        simulation.place(std::vector{PlacedParticle{0, to, glm::vec3(0.0f)}});
      }
    }
    return simulation.read();
  };
  const State expected = run(*make_host_reference(model, solver, "f32"));
  for (const std::uint32_t threads : {1u, 3u})
    expect_same_state(run(*make_native_simulation(model, solver, "f32", {.threads = threads})), expected);
}

}  // namespace
}  // namespace weft
