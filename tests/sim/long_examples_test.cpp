// What the example scenes promise of themselves, their [expect] blocks, holds on the device. The six scenes
// are in tests/physics/six_scenes_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>

#include "gpu_fixture.h"
#include "scene/reader.h"
#include "sim/expect.h"
#include "sim/gpu_simulation.h"

namespace weft {
namespace {

using LongExamples = test::GpuTest;

TEST_F(LongExamples, hold_what_they_expect) {
  const std::vector<AssetInfo> six = numbered_scenes();
  for (const AssetInfo& asset : list_scenes()) {
    if (std::ranges::find(six, asset.name, &AssetInfo::name) != six.end()) continue;
    const Model model = build_model(load_scene(find_scene(asset.name)).scene);
    const auto simulation = GpuSimulation::create(device(), model, find_solver(model.scene.solver.name));
    const std::vector<Verdict> verdicts = run_expectations(*simulation, 5.0);
    EXPECT_FALSE(verdicts.empty()) << asset.name << " promises nothing";
    EXPECT_TRUE(all_hold(verdicts)) << asset.name << "\n" << describe(verdicts);
  }
}

}  // namespace
}  // namespace weft
