// Contact with bodies runs in those substeps in which the cloth comes near one, the strain limit and tearing
// in which a link comes near it, and a cloth is gathered as torn once it is; all of that ends in the bits of
// passes that always run.
#include <gtest/gtest.h>

#include <algorithm>

#include "reach_fixture.h"
#include "sim/cpu_simulation.h"
#include "sim/native_simulation.h"

namespace weft::test {
namespace {

/// The reference that counts in how many substeps contact or the limit had to run, or makes them run in all.
template <class T>
class Counting final : public CpuSimulation<T> {
 public:
  Counting(const Model& model, const ReachCase& c, bool always)
      : CpuSimulation<T>(model, find_solver(c.solver), c.precision), case_(c) {
    if (always) this->buffers_.words_of(BufferId::reach_groups).clear();
    this->write(start_state(model));
  }
  std::uint32_t substeps = 0, near = 0;

 private:
  ReachCase case_;
  void run_substeps(std::uint32_t first, std::uint32_t count) override {
    for (std::uint32_t k = first; k < first + count; ++k, ++substeps)
      for (const PlanStep& step : this->plan_.steps) {
        if (step.block != Block::substep) continue;
        this->run_step(step, k);
        const auto& words = this->buffers_.words_of(BufferId::reach_groups);
        near += step.pass->swaps_state && !words.empty() && words[case_.word] != 0 ? 1 : 0;
      }
  }
};

template <class T>
void expect_bits_of_contact_in_every_substep(const ReachCase& c) {
  SCOPED_TRACE(c.name);
  const Model model = reach_model(c);
  ASSERT_TRUE(compile_plan(model, find_solver(c.solver), c.precision).reaching.asked());
  Counting<T> asking(model, c, false), always(model, c, true);
  Counting<T> missing(reach_model({"", kFarCapsule, c.solver, c.precision}), c, true);
  for (Simulation* simulation : {static_cast<Simulation*>(&asking), static_cast<Simulation*>(&always),
                                 static_cast<Simulation*>(&missing)})
    run_frames(*simulation, 4);
  expect_same(asking.read(), always.read(), "what is asked for, and what always runs");
  EXPECT_NE(state_hash(asking.read()), state_hash(missing.read())) << "nothing was touched";
  EXPECT_GT(asking.near, 0u);
  EXPECT_LT(asking.near, asking.substeps) << "there was nothing to leave out";
}

TEST(Reach, WhatIsAskedForHasTheBitsOfWhatRunsInEverySubstep) {
  for (const ReachCase& c : reach_cases())
    if (std::string_view(c.precision) == "f64")
      expect_bits_of_contact_in_every_substep<double>(c);
    else
      expect_bits_of_contact_in_every_substep<float>(c);
}

// 100 m below nothing ever runs, and the cloth moves as if the body were not there.
TEST(Reach, BodiesFarAwayAreNothing) {
  const ReachCase c{"far", kFarCapsule}, none{"none", ""};
  Counting<float> far(reach_model(c), c, false), without(reach_model(none), none, false);
  run_frames(far, 6);
  run_frames(without, 6);
  EXPECT_EQ(far.near, 0u);
  EXPECT_GT(far.substeps, 0u);
  expect_same(far.read(), without.read(), "with a capsule 100 m below and without");
}

// Which pass moves the cloth follows from the state that is written, whatever moved it before: a cloth that
// starts anew is whole, and one that was torn is torn from its first substep on.
TEST(Reach, AStateThatIsWrittenDecidesWhichPassMovesTheCloth) {
  for (const std::string& tearing : {kTearingBox, kTearingBalls}) {
    const ReachCase c{"written", tearing, "leapfrog", "f32", shared::kReachTorn};
    const Model model = reach_model(c);
    Counting<float> asking(model, c, false), always(model, c, true);
    const auto native = make_native_simulation(model, find_solver(c.solver), "f32", {});
    const std::vector<State> expected = written_over(always), got = written_over(asking),
                             vectors = written_over(*native);
    for (std::size_t k = 0; k < expected.size(); ++k) {
      expect_same(got[k], expected[k], fmt::format("reference, {}", k));
      expect_same(vectors[k], expected[k], fmt::format("native, {}", k));
      const bool torn = std::ranges::any_of(expected[k].broken_links, [](auto links) { return links != 0; });
      EXPECT_EQ(torn, k % 2 == 0) << k;
    }
    EXPECT_EQ(state_hash(expected[1]), state_hash(expected[3]));
  }
}

TEST(Reach, NativeEndsInTheSameBits) {
  for (const ReachCase& c : reach_cases()) {
    if (std::string_view(c.precision) != "f32") continue;
    const Model model = reach_model(c);
    const auto native = make_native_simulation(model, find_solver(c.solver), "f32", {});
    const auto reference = make_cpu_simulation(model, find_solver(c.solver), "f32");
    run_frames(*native, 4);
    run_frames(*reference, 4);
    expect_same(native->read(), reference->read(), c.name);
  }
}

}  // namespace
}  // namespace weft::test
