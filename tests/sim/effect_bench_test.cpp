// The table of what effects cost: every effect is in it, and what a scene lacks weighs nothing on either
// side.
#include "sim/effect_bench.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "core/error.h"
#include "gpu_fixture.h"
#include "scene/effects.h"
#include "scene/reader.h"

namespace weft {
namespace {

class EffectBenchTest : public test::GpuTest {};

TEST_F(EffectBenchTest, HasARowForEachEffectWithItsBytesAndDispatches) {
  const Scene scene =
      parse_scene("[cloth]\nresolution = 8\n[gravity]\n[solver]\nsubsteps = 6\n", "small.toml").scene;
  std::vector<std::string> told;
  const EffectBenchReport report = bench_effects(device(), scene, {.time_s = 0.05, .repetitions = 2},
                                                 [&](const std::string& effect) { told.push_back(effect); });
  ASSERT_EQ(report.rows.size(), effects().size());
  EXPECT_EQ(told.size(), report.rows.size());
  const Plan plan = compile_plan(build_model(scene), find_solver("leapfrog"));
  for (std::size_t r = 0; r < report.rows.size(); ++r) {
    const EffectRow& row = report.rows[r];
    EXPECT_EQ(row.effect, effects()[r].name);
    if (!row.left_out.empty()) continue;
    EXPECT_GT(row.with.frame_ms.median, 0.0) << row.effect;
    EXPECT_GT(row.without.frame_ms.median, 0.0) << row.effect;
    EXPECT_GE(row.with.bytes, row.without.bytes) << row.effect;
    EXPECT_EQ(row.in_scene, row.effect == "gravity" || row.effect == "damping") << row.effect;
    if (row.in_scene || !find_effect(row.effect).needs.empty()) continue;
    EXPECT_EQ(row.without.bytes, plan.bytes()) << row.effect << ": what the scene lacks has no byte";
  }
}

// A turn that is cut short gives a whole frame's milliseconds: a frame of 60 substeps, timed by 6 of them,
// takes some ten times as long as those, and not what they take. Dispatches and bytes are the whole frame's.
TEST_F(EffectBenchTest, TimesTheEffectsThatAreNamedInAsManySubstepsAsItMay) {
  const Scene scene =
      parse_scene("[cloth]\nresolution = 8\n[gravity]\n[solver]\nsubsteps = 60\n", "small.toml").scene;
  const auto row_of_floor = [&](double turn_most) {
    const EffectBenchReport report = bench_effects(
        device(), scene,
        {.time_s = 1.0, .repetitions = 5, .only = {"floor"}, .turn_most = turn_most, .warm_most = 640},
        [](const std::string&) {});
    EXPECT_EQ(report.rows.size(), 1u);
    EXPECT_NEAR(report.time_s, 10.0 / 60 / 60, 1e-9) << "640 particle·substeps are ten substeps of 64";
    return report.rows.at(0);
  };
  const EffectRow whole = row_of_floor(1e7), part = row_of_floor(6 * 64);
  EXPECT_EQ(whole.effect, "floor");
  EXPECT_EQ(part.with.dispatches, whole.with.dispatches);
  EXPECT_EQ(part.with.bytes, whole.with.bytes);
  if (std::getenv("WEFT_FULL") != nullptr) {  // on a busy machine times say little
    EXPECT_GT(part.with.frame_ms.median, 0.3 * whole.with.frame_ms.median);
  }
  EXPECT_THROW(bench_effects(device(), scene, {.only = {"glue"}}, [](const std::string&) {}), Error);
}

}  // namespace
}  // namespace weft
