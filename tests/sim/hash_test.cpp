// The state's hash: the same from every kernel, from the CPU reference, and from one version to the next.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "gpu_fixture.h"
#include "sim/gpu_simulation.h"
#include "sim/kernels.h"
#include "sim/scenes.h"

namespace weft::test {
namespace {

class HashTest : public GpuTest {};

constexpr const char* kGoldenFile = WEFT_SOURCE_DIR "/tests/golden/hashes.json";

std::string hash_after(Simulation& simulation, int frames) {
  for (int f = 0; f < frames; ++f)
    simulation.advance(simulation.model().scene.solver.frame_s, simulation.plan().substeps);
  return fmt::format("{:016x}", state_hash(simulation.read()));
}

// Software drivers divide and take roots as IEEE says, so that the bits are the same on any of them and on
// any machine. 12 frames at 32 particles along the width. Run
// with WEFT_UPDATE_GOLDENS=1 to write them anew.
TEST_F(HashTest, IsItsGoldenCopyForEachSceneFromEveryKernelAndTheReference) {
  if (!device().info().software) GTEST_SKIP() << "golden hashes are those of software drivers";
  constexpr int kFrames = 12;
  nlohmann::ordered_json golden;
  if (std::ifstream file(kGoldenFile); file) golden = nlohmann::ordered_json::parse(file);
  for (const AssetInfo& asset : numbered_scenes()) {
    const Model model = scene_model(asset.name, {{"cloth.resolution=32"}});
    const Solver& leapfrog = find_solver("leapfrog");
    const std::string expected = hash_after(*make_cpu_simulation(model, leapfrog, "f32"), kFrames);
    if (std::getenv("WEFT_UPDATE_GOLDENS") != nullptr) golden[asset.name] = expected;
    EXPECT_EQ(golden.value(asset.name, ""), expected)
        << asset.name << ": WEFT_UPDATE_GOLDENS=1 writes it anew";
    for (const std::string& kernel : fitting_kernel_names(device(), compile_plan(model, leapfrog))) {
      const auto simulation = GpuSimulation::create(device(), model, leapfrog, {.kernel = kernel});
      EXPECT_EQ(hash_after(*simulation, kFrames), expected) << asset.name << ", kernel " << kernel;
    }
  }
  if (std::getenv("WEFT_UPDATE_GOLDENS") != nullptr) std::ofstream(kGoldenFile) << golden.dump(2) << "\n";
}

}  // namespace
}  // namespace weft::test
