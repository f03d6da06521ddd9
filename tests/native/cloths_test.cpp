// Several cloths by the vector kernels: the bits of the float reference, wherever bands part the rows.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "model/measures.h"
#include "native/features.h"
#include "scene/reader.h"
#include "sim/native_simulation.h"
#include "solvers/solver.h"

namespace weft {
namespace {

/// Three cloths, of numbers of rows and columns that no vector and no band divides; over each other, held by
/// pins that stay, move and let go, in wind, above a floor and a ball.
constexpr const char* kThree = R"(
[cloth]
resolution = 21
height = 0.4
center = [0, 1, 0]
orientation = "horizontal"
imperfection = 0.01
[[cloths]]
center = [0.1, 1.04, 0.05]
[[cloths]]
center = [-0.1, 1.02, 0.3]
imperfection = 0.02
[material]
bend = 1e-4
[[pins]]
at = [0, 0]
[[pins]]
at = [1, 0]
cloth = 1
keys = [{ time = 0, offset = [0, 0, 0] }, { time = 0.1, offset = [0.02, 0.1, 0] }]
[[pins]]
at = [1, 1]
cloth = 2
release = 0.02
[gravity]
[air]
drag = 0.2
[wind]
velocity = [0.5, 0.0, 3.0]
[floor]
height = 0.97
friction = 0.3
[[spheres]]
center = [0, 0.9, 0.1]
radius = 0.12
friction = 0.3
)";

Model three(const std::string& more, std::vector<std::string> set = {}) {
  return build_model(parse_scene(kThree + more, "three.toml", {std::move(set)}).scene);
}

/// Position, velocity and what is drawn after so many frames.
struct Ended {
  State state;
  std::vector<glm::vec4> position, normal;
};

Ended ended(HostSimulation& simulation, int frames) {
  const Model& model = simulation.model();
  for (int f = 0; f < frames; ++f) simulation.advance(model.scene.solver.frame_s, simulation.plan().substeps);
  Ended end{.state = simulation.read(),
            .position = std::vector<glm::vec4>(model.grid.count()),
            .normal = std::vector<glm::vec4>(model.grid.count())};
  simulation.write_drawn({&end.position.data()->x, &end.normal.data()->x});
  return end;
}

/// Every width in one thread; then each number of threads, of which some part the rows within a cloth, some
/// between two, and some where one row of a cloth would be left over. −0 and +0 agree. Returns the
/// reference's hash.
std::uint64_t expect_as_reference(const Model& model, const std::string& solver_name, int frames = 2,
                                  std::vector<std::uint32_t> threads = {2, 3, 4, 5}) {
  SCOPED_TRACE(fmt::format("{} with {} cloths of {} x {}", solver_name, model.grid.cloths, model.grid.nx,
                           model.grid.ny));
  const Solver& solver = find_solver(solver_name);
  EXPECT_EQ(native_lacks(model, solver, "f32"), "");
  const Ended expected = ended(*make_host_reference(model, solver, "f32"), frames);
  EXPECT_NE(state_hash(expected.state), state_hash(start_state(model)));
  const auto expect_in = [&](const native::EngineOptions& options) {
    SCOPED_TRACE(fmt::format("{}, {} threads", options.vector, options.threads));
    const Ended got = ended(*make_native_simulation(model, solver, "f32", options), frames);
    for (std::size_t p = 0; p < got.normal.size(); ++p) {
      ASSERT_EQ(got.state.position[p], expected.state.position[p]) << "position of particle " << p;
      ASSERT_EQ(got.state.velocity[p], expected.state.velocity[p]) << "velocity of particle " << p;
      ASSERT_EQ(got.position[p], expected.position[p]) << "what is drawn of particle " << p;
      ASSERT_EQ(got.normal[p], expected.normal[p]) << "normal of particle " << p;
    }
  };
  for (const native::Kernels* kernels : native::kernels_here())
    expect_in({.threads = 1, .vector = kernels->name});
  for (const std::uint32_t count : threads) expect_in({.threads = count, .vector = {}});
  return state_hash(expected.state);
}

TEST(NativeCloths, EqualTheReferenceWithEverySolver) {
  for (const char* solver : {"leapfrog", "symplectic-euler", "velocity-verlet", "xpbd"})
    expect_as_reference(three(""), solver);
}

/// Two rows and three are cloths without an inner row; 32 of five rows have a border near every end.
TEST(NativeCloths, OfFewRowsEqualTheReference) {
  for (const char* solver : {"leapfrog", "xpbd"}) {
    for (const char* height : {"0.05", "0.1", "0.15"})
      expect_as_reference(three("", {fmt::format("cloth.height={}", height)}), solver, 1, {2, 3});
    std::string many;
    for (int k = 3; k < 16; ++k) many += fmt::format("[[cloths]]\ncenter = [{}, 1, 0]\n", 1.5 * k);
    expect_as_reference(three(many, {"cloth.height=0.2", "cloth.resolution=17"}), solver, 1,
                        {2, 3, 5, 7, 9, 11, 13, 20});
  }
}

/// Passes of their own, on the cloths' rows and as mirrors; each effect acts, or the bits would be those
/// without it.
TEST(NativeCloths, EqualTheReferenceWithEveryEffect) {
  const std::string air = "[aerodynamics]\n",
                    box = "[[boxes]]\ncenter = [0.3, 0.95, 0.1]\nsize = [0.3, 0.2, 0.3]\nfriction = 0.2\n";
  const auto ended_without = [](const char* solver) {
    return state_hash(ended(*make_host_reference(three(""), find_solver(solver), "f32"), 2).state);
  };
  const std::uint64_t plain = ended_without("leapfrog");
  for (const std::string& more : {air, box})
    EXPECT_NE(expect_as_reference(three(more), "leapfrog", 2, {3, 4}), plain);
  EXPECT_NE(expect_as_reference(three("", {"material.strain_limit=0.002"}), "leapfrog", 2, {3}), plain);
  EXPECT_NE(expect_as_reference(three(box), "xpbd", 2, {3}), ended_without("xpbd"));
}

/// Cloths that start within a thickness of each other are pushed apart.
TEST(NativeCloths, EqualTheReferenceWhereTheyTouch) {
  const auto touching = [](const std::string& more) {
    return three("[self_collision]\nthickness = 0.045\n" + more, {"solver.substeps=40"});
  };
  const std::uint64_t apart = expect_as_reference(three("", {"solver.substeps=40"}), "leapfrog", 1, {});
  EXPECT_NE(expect_as_reference(touching(""), "leapfrog", 1, {3}), apart);
  expect_as_reference(
      touching("[aerodynamics]\n[[capsules]]\na = [-1, 0.93, 0.2]\nb = [1, 0.93, 0.2]\nradius = 0.08\n"),
      "leapfrog", 1, {4});
}

/// Two that come together, evenly and no faster than lists foresee: from the first list on contacts are due
/// at every look, though nobody leaves the lists' room for more substeps than that. For the pin of the third
/// one no motion counts as shared.
TEST(NativeCloths, LookAtTheirFirstContactsInTime) {
  const Model model = build_model(parse_scene(R"(
[cloth]
resolution = 21
orientation = "horizontal"
[[cloths]]
center = [0, 0.03, 0]
[[cloths]]
center = [5, 0, 0]
[[pins]]
at = [0, 0]
cloth = 2
[self_collision]
thickness = 0.0125
[solver]
substeps = 80
)",
                                              "meeting.toml")
                                      .scene);
  const Solver& solver = find_solver("leapfrog");
  State begun = start_state(model);
  const std::size_t each = begun.velocity.size() / 3;
  for (std::size_t p = 0; p < 2 * each; ++p) begun.velocity[p].y = p < each ? 0.3 : -0.3;
  const auto right = make_host_reference(model, solver, "f32"),
             got = make_native_simulation(model, solver, "f32", {.threads = 2});
  right->write(begun);
  got->write(begun);
  const Ended expected = ended(*right, 3), end = ended(*got, 3);
  EXPECT_LT(expected.state.velocity[each / 2].y, 0.2) << "they touch";
  for (std::size_t p = 0; p < end.state.position.size(); ++p) {
    ASSERT_EQ(end.state.position[p], expected.state.position[p]) << "position of particle " << p;
    ASSERT_EQ(end.state.velocity[p], expected.state.velocity[p]) << "velocity of particle " << p;
  }
  EXPECT_EQ(got->self_collision()->lists_built, right->self_collision()->lists_built);
}

}  // namespace
}  // namespace weft
