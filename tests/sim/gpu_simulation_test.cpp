// The GPU simulation: the reference's bits, the plan's counts, and bits that do not depend on how the work is
// cut.
#include "sim/gpu_simulation.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "gpu_fixture.h"
#include "passes/passes.h"
#include "plan/buffers.h"
#include "scenes.h"
#include "sim/gpu_program.h"

namespace weft::test {
namespace {

class GpuSimulationTest : public GpuTest {
 protected:
  static std::unique_ptr<GpuSimulation> on_gpu(const Model& model, const GpuSimulationOptions& options = {}) {
    return GpuSimulation::create(device(), model, find_solver("leapfrog"), options);
  }
  /// The state after one frame of at most `most` substeps and one short frame of 7.
  static State ran(GpuSimulation& simulation, std::uint32_t most = 40) {
    const std::uint32_t n = simulation.plan().substeps, k = std::min(n, most);
    const double frame_s = simulation.model().scene.solver.frame_s;
    simulation.advance(frame_s * k / n, k);
    simulation.advance(frame_s * 7 / n, 7);
    return simulation.read();
  }
};

// docs/float-form.md: on a device with IEEE division and square root the bits are the reference's.
TEST_F(GpuSimulationTest, equals_the_float_reference_for_100_substeps_of_every_scene) {
  for (const AssetInfo& asset : numbered_scenes()) {
    const Model model = build_model(load_scene(asset.file).scene);
    const auto gpu = on_gpu(model);
    const auto cpu = make_cpu_simulation(model, find_solver("leapfrog"), "f32");
    const std::uint32_t n = gpu->plan().substeps;
    for (std::uint32_t left = 100; left > 0;) {
      const std::uint32_t k = std::min(left, n);
      for (Simulation* s : {static_cast<Simulation*>(gpu.get()), cpu.get()})
        s->advance(model.scene.solver.frame_s * k / n, k);
      left -= k;
    }
    if (device().info().software)
      expect_same(gpu->read(), cpu->read(), asset.name);
    else
      EXPECT_LT(max_distance(gpu->read(), cpu->read()), 1e-4) << asset.name;
  }
}

TEST_F(GpuSimulationTest, equals_the_reference_with_every_effect_at_once) {
  if (!device().info().software) GTEST_SKIP() << "exact on software devices only";
  for (const char* more : {"", "\n[solver]\nsubsteps = 300\n"}) {
    const Model model = full_model(more);
    const auto gpu = on_gpu(model);
    const auto cpu = make_cpu_simulation(model, find_solver("leapfrog"), "f32");
    for (int frame = 0; frame < 6; ++frame)
      for (Simulation* s : {static_cast<Simulation*>(gpu.get()), cpu.get()})
        s->advance(model.scene.solver.frame_s, gpu->plan().substeps);
    ASSERT_TRUE(all_finite(cpu->read()));
    expect_same(gpu->read(), cpu->read(), more);
  }
}

// Boundary rows, lines of two and three particles, and marches that end inside the cloth.
TEST_F(GpuSimulationTest, equals_the_reference_on_odd_shapes) {
  if (!device().info().software) GTEST_SKIP() << "exact on software devices only";
  for (const auto& [resolution, height] :
       {std::pair{2, 1.0}, {3, 0.5}, {3, 1.0}, {5, 3.0}, {17, 0.06}, {70, 0.31}}) {
    const Model model = build_model(
        parse_scene(
            fmt::format("[cloth]\nresolution = {}\nheight = {:.3f}\nimperfection = 0.02\n[material]\nbend = "
                        "1e-5\n[gravity]\n[[pins]]\nat = [0.0, 0.0]\n",
                        resolution, height),
            "shape.toml")
            .scene);
    const auto gpu = on_gpu(model);
    const auto cpu = make_cpu_simulation(model, find_solver("leapfrog"), "f32");
    for (Simulation* s : {static_cast<Simulation*>(gpu.get()), cpu.get()})
      s->advance(model.scene.solver.frame_s, gpu->plan().substeps);
    expect_same(gpu->read(), cpu->read(), fmt::format("{} wide, {} high", model.grid.nx, model.grid.ny));
  }
}

TEST_F(GpuSimulationTest, gives_the_same_bits_twice) {
  const Model model = full_model();
  EXPECT_EQ(state_hash(ran(*on_gpu(model))), state_hash(ran(*on_gpu(model))));
}

TEST_F(GpuSimulationTest, gives_bits_that_do_not_depend_on_the_submits) {
  const Model model = full_model();
  const State whole = ran(*on_gpu(model, {.dispatches_per_submit = 4096}));
  for (const std::uint32_t dispatches : {1u, 2u, 7u, 16u}) {
    const auto simulation = on_gpu(model, {.dispatches_per_submit = dispatches, .kernel = "direct"});
    expect_same(ran(*simulation), whole, fmt::format("{} dispatches a submit", dispatches));
    // A kernel that takes one substep a dispatch: what another test remembers may take four.
    EXPECT_EQ(simulation->submit_count(),
              (12 + dispatches - 1) / dispatches);  // 7 substeps, closing kick, normals, three that watch
  }
}

TEST_F(GpuSimulationTest, gives_the_same_bits_through_the_staging_path) {
  const Model model = full_model();
  const State direct = ran(*on_gpu(model));
  const auto staged_device = make_device(true);
  const auto staged = GpuSimulation::create(*staged_device, model, find_solver("leapfrog"));
  expect_same(ran(*staged), direct, "staged");
  expect_silence(*staged_device);
}

TEST_F(GpuSimulationTest, records_the_dispatches_and_allocates_the_bytes_of_its_plan) {
  for (const AssetInfo& asset : numbered_scenes()) {
    const Model model = build_model(load_scene(asset.file).scene);
    const auto simulation = on_gpu(model);
    const Plan& plan = simulation->plan();
    const FrameStats stats = simulation->advance(model.scene.solver.frame_s, plan.substeps);
    EXPECT_EQ(stats.dispatches, simulation->dispatches_expected(plan.substeps)) << asset.name;
    EXPECT_EQ(simulation->bytes_allocated(), simulation->bytes_expected()) << asset.name;
    EXPECT_EQ(stats.spring_evaluations, (plan.substeps + 1) * model.spring_count) << asset.name;
  }
}

// Which buffers each of them binds: solver_validate_test.cpp.
TEST_F(GpuSimulationTest, has_a_pipeline_for_each_pass_and_not_for_each_step) {
  const Model model = full_model();
  const Plan plan = compile_plan(model, find_solver("leapfrog"));
  const GpuBuffers buffers(device(), model, plan);
  const GpuProgram program(device(), plan, buffers);
  for (std::size_t step = 0; step < plan.steps.size(); ++step)
    EXPECT_EQ(program.flips(step), plan.steps[step].pass->swaps_state);
  EXPECT_EQ(program.pipeline_count(), 5u);  // the closing kick shares the substep's pipeline
}

TEST_F(GpuSimulationTest, leaves_the_clock_where_the_frames_say_and_takes_short_ones) {
  const Model model = full_model();
  const auto simulation = on_gpu(model);
  const std::uint32_t n = simulation->plan().substeps;
  run_for(*simulation, 0.04, [](auto, auto, const FrameStats&) { return true; });
  EXPECT_NEAR(simulation->time_s(), 0.04, 1e-12);
  const auto cpu = make_cpu_simulation(model, find_solver("leapfrog"), "f32");
  run_for(*cpu, 0.04, [](auto, auto, const FrameStats&) { return true; });
  if (device().info().software) expect_same(simulation->read(), cpu->read(), "0.04 s");
  EXPECT_EQ(simulation->advance(1e-4, 1).dispatches, 6u);
  EXPECT_THROW(simulation->advance(1.0, 2 * substep_row_capacity(n)), Error);
}

TEST_F(GpuSimulationTest, reads_what_was_written) {
  const Model model = full_model();
  const auto simulation = on_gpu(model);
  const State later = ran(*simulation);
  const auto other = on_gpu(model);
  for (int odd = 0; odd < 2; ++odd) {  // both halves of the ping-pong
    other->write(later);
    expect_same(other->read(), later, "written");
    other->advance(1e-4, 2);
  }
  EXPECT_NEAR(other->time_s(), later.time_s + 1e-4, 1e-15);
}

TEST_F(GpuSimulationTest, times_every_step_of_the_plan) {
  if (!device().info().timestamps) GTEST_SKIP() << "no timestamps";
  const auto simulation = on_gpu(full_model());
  ran(*simulation);
  simulation->wait();
  const std::vector<double> ms = simulation->step_ms();
  ASSERT_EQ(ms.size(), simulation->plan().steps.size());
  for (const double step : ms) EXPECT_GT(step, 0.0);
}

// 4096² vec4s are 256 MiB a buffer; a device that binds so much is asked about one that it cannot.
TEST_F(GpuSimulationTest, refuses_a_cloth_that_the_device_cannot_hold_before_allocating) {
  const std::uint64_t range = device().limits().maxStorageBufferRange;
  if (range >= std::uint64_t{4096} * 4096 * 16)
    GTEST_SKIP() << "this device binds the largest cloth there is";
  const Model model =
      build_model(parse_scene("[cloth]\nresolution = 4096\n[solver]\nsubsteps = 10\n", "huge.toml").scene);
  try {
    on_gpu(model);
    FAIL() << "accepted";
  } catch (const Error& refusal) {
    EXPECT_EQ(refusal.code(), Exit::no_device);
    const auto fits = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(range / 16)));
    const std::string text = refusal.what();
    EXPECT_NE(text.find(std::to_string(compile_plan(model, find_solver("leapfrog")).bytes())),
              std::string::npos)
        << text;
    EXPECT_NE(text.find(fmt::format("largest resolution that fits is {}", fits)), std::string::npos) << text;
  }
}

TEST_F(GpuSimulationTest, refuses_a_solver_without_gpu_passes) {
  for (const Solver* solver : solvers()) {
    if (solver->on_gpu) continue;
    try {
      GpuSimulation::create(device(), full_model(), *solver);
      FAIL() << solver->name;
    } catch (const Error& refusal) {
      EXPECT_EQ(refusal.code(), Exit::usage);
    }
  }
}

}  // namespace
}  // namespace weft::test
