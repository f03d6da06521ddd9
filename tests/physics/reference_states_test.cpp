// The converged states in reference/ are reproduced: every formula of docs/physics.md at once.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "gpu_fixture.h"
#include "model/measures.h"
#include "model/state_io.h"
#include "scene/reader.h"
#include "sim/gpu_simulation.h"

namespace weft {
namespace {

struct Reference {
  const char* name;
  double time_s;
  double twin_m;      ///< RMS difference to a run started 1e-7 m away
  double step_max_s;  ///< leapfrog's largest stable step
  std::uint64_t springs;
};
constexpr Reference kReferences[] = {
    {"swing-two-corners", 0.3, 1.03e-5, 0.00024588, 5814},
    {"hang-in-wind", 0.4, 7.65e-5, 0.000237224, 6194},
    {"trampoline-stiff", 0.2, 3.54e-8, 7.35324e-5, 9178},
};

/// What both fixtures share: the scene, its converged state, and a run against it.
class WithReference : public testing::WithParamInterface<Reference> {
 protected:
  std::filesystem::path file(const char* extension) const {
    return std::filesystem::path(WEFT_SOURCE_DIR) / "tests/physics/reference" /
           (std::string(GetParam().name) + extension);
  }
  Model model() const { return build_model(load_scene(file(".toml")).scene); }

  Model paced_model() const {
    Model cloth = model();
    cloth.scene.solver.substeps = substeps_per_frame(cloth, find_solver("leapfrog"));
    return cloth;
  }

  /// RMS position error at the reference's time with the leapfrog's automatic number of substeps.
  double error_m(const char* solver, const char* precision) const {
    const Model cloth = paced_model();
    const auto simulation = make_cpu_simulation(cloth, find_solver(solver), precision);
    return error_of(*simulation, solver, precision);
  }
  double error_of(Simulation& simulation, const char* solver, const char* precision) const {
    run_for(simulation, GetParam().time_s, [](auto...) { return true; });
    EXPECT_NEAR(simulation.time_s(), GetParam().time_s, 1e-12);
    const double rms_m = rms_distance(simulation.read(), read_csv(file(".csv"), simulation.model().grid));
    std::printf("  %s %s %s, %s: %.3g m RMS\n", GetParam().name, solver, precision,
                simulation.device_name().c_str(), rms_m);
    return rms_m;
  }
};

class ReferenceStates : public testing::Test, public WithReference {};
class ReferenceStatesOnTheDevice : public test::GpuTest, public WithReference {};

TEST_P(ReferenceStates, SpringCountAndStepBound) {
  const Model cloth = model();
  EXPECT_EQ(cloth.spring_count, GetParam().springs);
  EXPECT_NEAR(find_solver("leapfrog").step_max_s(cloth.bound), GetParam().step_max_s,
              5e-6 * GetParam().step_max_s);
}

// A wrong formula shows as 1e-4 m or more; the method's own error at this step is some 1e-9 m.
TEST_P(ReferenceStates, RungeKuttaInDouble) { EXPECT_LE(error_m("rk4", "f64"), 1e-7); }

TEST_P(ReferenceStates, LeapfrogInFloat) {
  EXPECT_LE(error_m("leapfrog", "f32"), std::max(1e-4, 5 * GetParam().twin_m));
}

TEST_P(ReferenceStates, LeapfrogInDouble) {
  EXPECT_LE(error_m("leapfrog", "f64"), std::max(1e-4, 5 * GetParam().twin_m));
}

TEST_P(ReferenceStatesOnTheDevice, LeapfrogInFloat) {
  const auto simulation = GpuSimulation::create(device(), paced_model(), find_solver("leapfrog"));
  EXPECT_LE(error_of(*simulation, "leapfrog", "f32"), std::max(1e-4, 5 * GetParam().twin_m));
}

std::string test_name(const testing::TestParamInfo<Reference>& reference) {
  std::string name = reference.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(All, ReferenceStates, testing::ValuesIn(kReferences), test_name);
INSTANTIATE_TEST_SUITE_P(All, ReferenceStatesOnTheDevice, testing::ValuesIn(kReferences), test_name);

}  // namespace
}  // namespace weft
