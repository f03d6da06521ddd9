// Every example scene from its start, at its own resolution (three cloths at a lesser one): native ends in
// the bits of the float reference in any number of threads and at every vector width that this machine has.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <utility>

#include "model/measures.h"
#include "native/features.h"
#include "scene/reader.h"
#include "sim/native_simulation.h"
#include "solvers/solver.h"

namespace weft {
namespace {

State two_seconds(Simulation& simulation) {
  const double frame_s = simulation.model().scene.solver.frame_s;
  for (int f = 0; f * frame_s < 2.0; ++f) simulation.advance(frame_s, simulation.plan().substeps);
  return simulation.read();
}

void expect_native_as_reference(const std::string& scene, std::vector<std::string> set = {}) {
  const Model model = build_model(load_scene(find_scene(scene), {std::move(set)}).scene);
  const Solver& solver = find_solver(model.scene.solver.name);
  ASSERT_EQ(native_lacks(model, solver, "f32"), "");
  const State expected = two_seconds(*make_cpu_simulation(model, solver, "f32"));
  const auto expect_in = [&](const native::EngineOptions& options) {
    SCOPED_TRACE(fmt::format("{} {}, {} threads", scene, options.vector, options.threads));
    const State got = two_seconds(*make_native_simulation(model, solver, "f32", options));
    EXPECT_EQ(state_hash(got), state_hash(expected));
    EXPECT_EQ(got.broken_links, expected.broken_links);
  };
  for (const native::Kernels* kernels : native::kernels_here())
    expect_in({.threads = 1, .vector = kernels->name});
  for (const std::uint32_t threads : {2u, 3u, 8u}) expect_in({.threads = threads, .vector = {}});
}

TEST(NativeScenes, EndInTheBitsOfTheReference) {
  for (const char* scene : {"1", "2", "3", "4", "5", "6", "boxes", "drape", "rail", "released", "ring",
                            "slope", "storm", "tearing", "tethers"})
    expect_native_as_reference(scene);
}

// They fall on the ball and on each other within these two seconds.
TEST(NativeScenes, ThreeClothsEndInTheBitsOfTheReference) {
  expect_native_as_reference("layers", {"cloth.resolution=24"});
}

}  // namespace
}  // namespace weft
