// The table of what effects cost: every effect is in it, and what a scene lacks weighs nothing on either
// side.
#include "sim/effect_bench.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace weft
