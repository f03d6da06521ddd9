// What the six scenes promise of themselves, their [expect] blocks, holds on the device and on the reference.
#include <gtest/gtest.h>

#include "gpu_fixture.h"
#include "scene/reader.h"
#include "sim/expect.h"
#include "sim/gpu_simulation.h"

namespace weft {
namespace {

constexpr double kRunS = 5.0;  // what `weft simulate` runs without --time

Model shipped_scene(int number) { return build_model(load_scene(find_scene(std::to_string(number))).scene); }

void expect_all_hold(Simulation& simulation) {
  const std::vector<Verdict> verdicts = run_expectations(simulation, kRunS);
  EXPECT_GE(verdicts.size(), 3u) << "a scene that ships says how far it stretches and where it stays";
  EXPECT_TRUE(all_hold(verdicts)) << simulation.device_name() << "\n" << describe(verdicts);
}

class SixScenes : public test::GpuTest, public testing::WithParamInterface<int> {};

TEST_P(SixScenes, HoldWhatTheyExpectOnTheDevice) {
  const Model model = shipped_scene(GetParam());
  expect_all_hold(*GpuSimulation::create(device(), model, find_solver(model.scene.solver.name)));
}

TEST_P(SixScenes, HoldWhatTheyExpectOnTheReference) {
  const Model model = shipped_scene(GetParam());
  expect_all_hold(*make_cpu_simulation(model, find_solver(model.scene.solver.name), "f32"));
}

INSTANTIATE_TEST_SUITE_P(Shipped, SixScenes, testing::Range(1, 7));

TEST(ScenesThatShip, AreTheseSix) { EXPECT_EQ(numbered_scenes().size(), 6u); }

}  // namespace
}  // namespace weft
