// Scenes whose bodies come, go and stay away, for the tests of when contact runs.
#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "model/measures.h"
#include "scenes.h"
#include "shared/reach.h"
#include "sim/simulation.h"

namespace weft::test {

struct ReachCase {
  const char* name;
  std::string bodies;
  const char* solver = "leapfrog";
  const char* precision = "f32";
  std::uint32_t word = shared::kReachSolids;  ///< of reach_groups, whose substeps are counted
};

/// A cloth that lies in the air, held by one corner, with other sections.
inline Model reach_model(const ReachCase& c, std::uint32_t resolution = 12) {
  const std::string text = fmt::format(
      "[cloth]\nresolution = {}\nheight = 0.8\norientation = \"horizontal\"\ncenter = [0, 0.9, 0]\n"
      "imperfection = 0.01\n[[pins]]\nat = [0, 0]\n[gravity]\n[floor]\nheight = 0.5\n{}[solver]\nprecision = "
      "\"{}\"\n",
      resolution, c.bodies, c.precision);
  return build_model(parse_scene(text, WEFT_SOURCE_DIR "/assets/scenes/reach.toml").scene);
}

/// Through the cloth at 150 m/s, in the second frame alone.
inline const std::string kFastBox =
    "[[boxes]]\nsize = [0.3, 0.05, 0.3]\nfriction = 0.2\nkeys = [{ time = 0, center = [0, -2, 0] }, { time = "
    "0.02, center = [0.1, -1, 0] }, { time = 0.04, center = [0.1, 2, 0.1], rotation = [30, 50, 0] }]\n";
inline const std::string kFarCapsule =
    "[[capsules]]\na = [-0.5, -100, 0]\nb = [0.5, -100, 0]\nradius = 0.1\n";
/// Arrives in the same substeps as the fast box.
inline const std::string kFastMesh =
    "[[meshes]]\nfile = \"../meshes/ring.obj\"\nresolution = 12\nkeys = [{ time = 0, center = [0.2, -2, 0] "
    "}, "
    "{ time = 0.02, center = [0.2, -0.9, 0] }, { time = 0.04, center = [0.1, 2, 0.1], rotation = [60, 0, 0] "
    "}]\n";
/// Reaches the cloth in the third frame.
inline const std::string kRisingCapsule =
    "[[capsules]]\na = [-0.5, 0.7, 0]\nb = [0.5, 0.7, 0.1]\nradius = 0.02\nfriction = 0.3\nvelocity = [0, 4, "
    "0]\n";

/// The cloth falls freely but for its pinned corner, whose links reach 2 % within four frames.
inline const std::string kLimit = "[material]\nmembrane = 40\nstrain_limit = 0.02\n";
inline const std::string kStiffLimit = "[material]\nstrain_limit = 0.3\n";

/// The same links come near the first strain, and break at the second.
inline const std::string kStrained = "[material]\nmembrane = 40\n[tearing]\nstrain = 0.02\n";
inline const std::string kBreaking = "[material]\nmembrane = 40\n[tearing]\nstrain = 0.01\n";
inline const std::string kTearingBox = kFastBox + "[tearing]\nstrain = 0.2\n";
/// Nobody looks at links where pins move: the held corner is drawn out of the cloth.
inline const std::string kTearingPin =
    "[[pins]]\nat = [1, 1]\nkeys = [{ time = 0, offset = [0, 0, 0] }, { time = 0.05, offset = [0.5, 0, 0] "
    "}]\n"
    "[tearing]\nstrain = 0.2\n";
/// Comes down on the cloth with two others near it, which kernels look at late.
inline const std::string kTearingBalls =
    "[[spheres]]\ncenter = [0.1, 1.4, 0]\nradius = 0.12\nvelocity = [0, -20, 0]\n[[spheres]]\ncenter = "
    "[-0.3, 0.6, 0.1]\nradius = 0.1\n[[spheres]]\ncenter = [0.4, 0.9, 0.7]\nradius = 0.1\n"
    "[tearing]\nstrain = 0.15\n";

inline void run_frames(Simulation& simulation, int frames) {
  for (int f = 0; f < frames; ++f)
    simulation.advance(simulation.model().scene.solver.frame_s, simulation.plan().substeps);
}

/// Every word of the state after a run that tears, a start anew, the torn state again, and the whole one.
inline std::vector<State> written_over(Simulation& simulation) {
  std::vector<State> seen;
  const State start = start_state(simulation.model());
  const auto go_on = [&](int frames) {
    run_frames(simulation, frames);
    seen.push_back(simulation.read());
  };
  go_on(4);
  for (const State& state : {start, seen.front(), start}) {
    simulation.write(state);
    go_on(1);
  }
  return seen;
}

inline std::vector<ReachCase> reach_cases() {
  return {
      {"a fast box", kFastBox},
      {"a far capsule and a fast box", kFarCapsule + kFastBox},
      {"a box and a mesh in one substep", kFastBox + kFastMesh},
      {"a fast mesh, xpbd", kFastMesh, "xpbd"},
      {"a rising capsule, f32k", kRisingCapsule, "leapfrog", "f32k"},
      {"what a fast box tears", kTearingBox, "leapfrog", "f32", shared::kReachTorn},
      {"links that come near breaking", kStrained, "leapfrog", "f32", shared::kReachTear},
      {"links that break, f32k", kBreaking, "leapfrog", "f32k", shared::kReachTorn},
      {"links that break, symplectic-euler in f64", kBreaking, "symplectic-euler", "f64", shared::kReachTorn},
      {"a pin that tears", kTearingPin, "leapfrog", "f32", shared::kReachTorn},
      {"a rising capsule, symplectic-euler in f64", kRisingCapsule, "symplectic-euler", "f64"},
      {"a limit that the pin's links come to", kLimit, "leapfrog", "f32", shared::kReachLinks},
      {"a limit that a fast box brings links to", kStiffLimit + kFastBox, "leapfrog", "f32",
       shared::kReachLinks},
      {"a limit and a fast box, xpbd", kLimit + kFastBox, "xpbd"},
      {"a limit, f32k", kLimit, "leapfrog", "f32k", shared::kReachLinks},
      {"a limit, symplectic-euler in f64", kLimit, "symplectic-euler", "f64", shared::kReachLinks}};
}

}  // namespace weft::test
