// What a run of a hard case has to hold, shared by the quick and the long tests.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gpu_fixture.h"
#include "model/measures.h"
#include "sim/gpu_simulation.h"
#include "sim/native_simulation.h"
#include "support/hard_cases.h"

namespace weft::hard {

class JudgedTest : public test::GpuTest {
 protected:
  static MakeSimulation on_cpu() {
    return [](const Model& model, const Solver& solver) { return make_cpu_simulation(model, solver, "f32"); };
  }
  static MakeSimulation natively() {
    return
        [](const Model& model, const Solver& solver) { return make_native_simulation(model, solver, "f32"); };
  }
  static MakeSimulation on_device() {
    const auto pipelines = std::make_shared<GpuPipelines>(device());
    return [pipelines](const Model& model, const Solver& solver) -> std::unique_ptr<Simulation> {
      return GpuSimulation::create(device(), model, solver, {.pipelines = pipelines});
    };
  }

  /// The default solver: nothing diverges, nobody is inside a single collider by more than 1 % of its radius,
  /// nothing tunnels, no energy is created, a free cloth keeps its momentum.
  static void judge_default(const HardCase& c, const Outcome& outcome, const char* where) {
    SCOPED_TRACE(fmt::format("{} on the {}", c.name, where));
    EXPECT_FALSE(outcome.divergence) << outcome.cause;
    if (c.one_collider) {
      EXPECT_LE(outcome.inside, 0.01);
      EXPECT_GT(outcome.inside, 0.0) << "who is put on a surface is inside by a rounding: nothing touched it";
    }
    if (c.hand == Hand::none) {  // a hand puts colliders over the cloth
      EXPECT_EQ(outcome.tunnelled, 0u);
    }
    if (c.closed) {
      EXPECT_LE(outcome.energy_gain, c.energy_tolerance);
    }
    const bool forceless = c.closed && c.scene == "free" && c.set.empty();
    if (forceless) {
      EXPECT_LE(outcome.momentum_drift, 1e-5);
    }
    EXPECT_TRUE(std::isfinite(outcome.max_stretch));
  }

  /// Any other solver: finite, or found out with its cause.
  static void judge_other(const HardCase& c, const Outcome& outcome, std::string_view solver,
                          const char* where) {
    SCOPED_TRACE(fmt::format("{}, {} on the {}", c.name, solver, where));
    EXPECT_TRUE(all_finite(outcome.end));
    if (outcome.divergence)
      EXPECT_NE(outcome.cause, "");
    else
      EXPECT_TRUE(std::isfinite(outcome.max_stretch));
  }
};

}  // namespace weft::hard
