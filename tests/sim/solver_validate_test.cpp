// Every solver's passes on the device against their mirrors, and the shaders' interfaces against the plan's.
#include <gtest/gtest.h>

#include <algorithm>

#include "gpu_fixture.h"
#include "plan/plan.h"
#include "scenes.h"
#include "sim/gpu_program.h"
#include "sim/validate.h"

namespace weft::test {
namespace {

class SolverValidateTest : public GpuTest {};

// Software devices must be exact, others within what float loses; 20 substeps and two frames in
// lockstep.
TEST_F(SolverValidateTest, every_solver_equals_its_mirrors) {
  for (const Solver* solver : solvers()) {
    if (!solver->on_gpu) continue;
    // Explicit Euler needs tiny steps to stay finite for three frames; what has overflowed compares to
    // nothing.
    const bool fails = solver->name == "euler";
    const Model full = full_model(fails ? "[solver]\nsubsteps = 2000\n" : "");
    const Model hung = scene_model(
        "1", {{"cloth.resolution=33", fails ? "solver.substeps=2000" : "solver.substeps=\"auto\""}});
    for (const Model* model : {&full, &hung}) {
      const ValidationReport report =
          validate(device(), *model, *solver, {.lockstep_substeps = 20, .lockstep_frames = 2});
      EXPECT_GT(report.rows.size(), 10u);
      for (const ValidationRow& row : report.rows)
        EXPECT_TRUE(row.ok) << solver->name << " on " << model->scene.title << ": " << row.check << ", "
                            << row.state << ", " << row.buffer << ": " << row.verdict << ", max "
                            << row.max_abs << ", " << row.max_ulp << " ulp";
    }
  }
}

// The compensated passes too, where a solver has them.
TEST_F(SolverValidateTest, every_compensated_form_equals_its_mirrors) {
  const Model model = full_model("[solver]\nprecision = \"f32k\"\n");
  for (const Solver* solver : solvers()) {
    if (!has_compensated(*solver)) continue;
    const ValidationReport report =
        validate(device(), model, *solver, {.lockstep_substeps = 20, .lockstep_frames = 2});
    for (const ValidationRow& row : report.rows)
      EXPECT_TRUE(row.ok) << solver->name << ": " << row.check << ", " << row.state << ", " << row.buffer
                          << ": " << row.verdict << ", " << row.max_ulp << " ulp";
  }
}

// Without damping, bending and pins other code paths run.
TEST_F(SolverValidateTest, every_solver_equals_its_mirrors_on_a_bare_cloth) {
  const Model bare = build_model(parse_scene(R"(
[cloth]
resolution = 11
height = 0.6
[material]
damping = 0.0
flex = 0.0
[gravity]
)",
                                             "bare.toml")
                                     .scene);
  for (const Solver* solver : solvers()) {
    if (!solver->on_gpu) continue;
    const ValidationReport report = validate(device(), bare, *solver, {.lockstep_frames = 1});
    for (const ValidationRow& row : report.rows)
      EXPECT_TRUE(row.ok) << solver->name << ": " << row.check << ", " << row.state << ", " << row.buffer
                          << ": " << row.verdict << ", " << row.max_ulp << " ulp";
  }
}

// buffers_of() restates what the shaders declare; the SPIR-V decides. A module of another precision than the
// plan's would have elements of another size.
TEST_F(SolverValidateTest, every_shader_binds_what_the_plan_says) {
  const Model model = full_model("[self_collision]\nthickness = 0.02\n"), bare = full_model();
  for (const Solver* solver : solvers())
    for (const char* precision : {"f32", "f64"}) {
      const bool in_double = precision == std::string("f64");
      if (!solver->on_gpu || (in_double && !device().info().float64)) continue;
      const Model& shown = solver->name == "leapfrog" ? model : bare;
      const Plan plan = compile_plan(shown, *solver, precision);
      const GpuBuffers buffers(device(), shown, plan);
      const GpuProgram program(device(), plan, buffers);
      for (std::size_t step = 0; step < plan.steps.size(); ++step) {
        std::vector<BufferId> bound;
        for (const gpu::Binding& binding : program.pipeline(step).reflection().bindings) {
          const BufferRow& row = row_of(bound.emplace_back(BufferId{binding.binding}));
          const std::uint32_t bytes = in_double ? row.element_bytes_double : row.element_bytes;
          EXPECT_EQ(binding.stride, row.id == BufferId::params ? 0 : bytes)  // one block, no array
              << plan.steps[step].pass->name << ": " << row.name;
        }
        const auto planned = buffers_of(*plan.steps[step].pass);
        EXPECT_TRUE(std::ranges::equal(bound, planned)) << plan.steps[step].pass->name;
      }
    }
}

}  // namespace
}  // namespace weft::test
