// The device asks whether the cloth comes near a body as the mirrors do, with every kernel, and its contact
// has no workgroups where it does not.
#include "passes/passes.h"
#include "passes/reach.h"
#include "passes/tables.h"
#include "reach_fixture.h"
#include "sim/gpu_simulation.h"
#include "sim/kernels.h"
#include "sim/pass_runner.h"
#include "validated_pass.h"

namespace weft::test {
namespace {

constexpr std::uint32_t kResolution = 70;  // two workgroups a row

class ReachGpuTest : public ValidatedPassTest {};

TEST_F(ReachGpuTest, EveryKernelEndsInTheBitsOfTheReference) {
  const auto pipelines = std::make_shared<GpuPipelines>(device());
  for (const ReachCase& c : reach_cases()) {
    if (std::string_view(c.precision) == "f64" && !device().info().float64) continue;
    const Model model = reach_model(c);
    const Solver& solver = find_solver(c.solver);
    const Plan plan = compile_plan(model, solver, c.precision);
    const auto reference = make_cpu_simulation(model, solver, c.precision);
    for (int f = 0; f < 3; ++f) reference->advance(model.scene.solver.frame_s, plan.substeps);
    for (const std::string& kernel : fitting_kernel_names(device(), plan)) {
      const auto simulation =
          GpuSimulation::create(device(), model, solver, {.pipelines = pipelines, .kernel = kernel});
      for (int f = 0; f < 3; ++f) simulation->advance(model.scene.solver.frame_s, plan.substeps);
      if (device().info().software)
        expect_same(simulation->read(), reference->read(), fmt::format("{}, {}", c.name, kernel));
      EXPECT_EQ(simulation->bytes_allocated(), simulation->bytes_expected()) << c.name;
    }
  }
}

TEST_F(ReachGpuTest, AStateThatIsWrittenDecidesWhichPassMovesTheCloth) {
  const Model model = reach_model({"written", kTearingBox});
  const auto reference = make_cpu_simulation(model, find_solver("leapfrog"), "f32");
  const auto simulation = GpuSimulation::create(device(), model, find_solver("leapfrog"));
  const std::vector<State> expected = written_over(*reference), got = written_over(*simulation);
  for (std::size_t k = 0; k < expected.size() && device().info().software; ++k)
    expect_same(got[k], expected[k], fmt::format("after {}", k));
}

TEST_F(ReachGpuTest, EveryPassEqualsItsMirror) {
  EXPECT_GT(rows_of(reach_model({"", kRisingCapsule + kFastMesh}), "leapfrog", "mesh_contact"), 0u);
  EXPECT_GT(rows_of(reach_model({"", kRisingCapsule}), "xpbd", "solid_contact"), 0u);
}

/// Two words of reach_groups as the first substep's `integrate` leaves them.
std::array<std::uint32_t, 2> groups_after(gpu::Device& device, const Model& model, std::uint32_t one,
                                          std::uint32_t other) {
  const Plan plan = compile_plan(model, find_solver("leapfrog"));
  std::size_t step = 0;
  while (plan.steps[step].pass != &integrate) ++step;
  HostBuffers<float> host;
  size_buffers(plan, model, host);
  load_state(model, start_state(model), host);
  const auto rows = plan.solver->schedule(0.0, model.scene.solver.frame_s, plan.substeps);
  PassRunner runner(device, model, plan, Perturbation("", plan));
  const auto words = runner.run(step, host, rows, 0).buffers.words_of(BufferId::reach_groups);
  EXPECT_EQ(words.at(one + 1), model.grid.rows());
  return {words.at(one), words.at(other)};
}

TEST_F(ReachGpuTest, ContactHasNoWorkgroupsWhereBodiesAreFarAway) {
  const auto groups = [](const std::string& bodies) {
    return groups_after(device(), reach_model({"", bodies}, kResolution), shared::kReachSolids,
                        shared::kReachMeshes);
  };
  const std::string under = "[[boxes]]\ncenter = [0.4, 0.8, 0]\nsize = [0.1, 0.2, 0.1]\n";
  EXPECT_EQ(groups(kFarCapsule), (std::array{0u, 0u}));
  EXPECT_EQ(groups(under), (std::array{2u, 2u}));
}

// The uneven start strains links by more than half a thousandth, and by less than half.
TEST_F(ReachGpuTest, TearHasNoWorkgroupsWhereNoLinkIsNearBreaking) {
  const auto groups = [](const std::string& tearing) {
    return groups_after(device(), reach_model({"", tearing}, kResolution), shared::kReachTear,
                        shared::kReachTorn);
  };
  EXPECT_EQ(groups("[tearing]\nstrain = 1\n"), (std::array{0u, 0u}));
  EXPECT_EQ(groups("[tearing]\nstrain = 0.001\n"), (std::array{2u, 0u}));
}

}  // namespace
}  // namespace weft::test
