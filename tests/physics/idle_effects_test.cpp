// Effects that are called for and have nothing to do change no bit: at zero strength, or with nothing near.
#include <gtest/gtest.h>

#include "model/measures.h"
#include "scene/effects.h"
#include "scene/reader.h"
#include "sim/simulation.h"

namespace weft {
namespace {

/// A cloth that swings from a corner, in wind: every term of the integration is at work.
Scene swinging(const std::vector<std::string>& set = {}) {
  return parse_scene(
             "[cloth]\nresolution = 10\nimperfection = 0.01\n[material]\nbend = 2e-5\n[[pins]]\nat = [0, 0]\n"
             "radius = 0.15\n[gravity]\n[air]\ndrag = 0.1\n[wind]\nvelocity = [0, 0, 2]\n[solver]\nsubsteps "
             "= 60\n",
             "swing.toml", {set})
      .scene;
}

std::uint64_t hash_after_frames(const Scene& scene) {
  const auto simulation = make_cpu_simulation(build_model(scene), find_solver(scene.solver.name), "f32");
  for (int frame = 0; frame < 6; ++frame) simulation->advance(scene.solver.frame_s, scene.solver.substeps);
  return state_hash(simulation->read());
}

TEST(IdleEffects, ChangeNoBit) {
  const Scene scene = swinging();
  const std::uint64_t expected = hash_after_frames(scene);
  for (const char* effect :
       {"strain_limit", "floor", "spheres", "capsules", "boxes", "meshes", "self_collision", "tearing"})
    EXPECT_EQ(hash_after_frames(with_effect(scene, effect)), expected) << effect;
  EXPECT_EQ(hash_after_frames(swinging({"aerodynamics={drag=0, lift=0}"})), expected);
}

TEST(IdleEffects, ZeroStrengthIsAbsence) {
  struct Case {
    const char *effect, *zero;
  };
  for (const Case& c : {Case{"bend", "material.bend=0"}, Case{"damping", "material.damping=0"},
                        Case{"gravity", "gravity.acceleration=[0,0,0]"}, Case{"air", "air.drag=0"},
                        Case{"wind", "wind.velocity=[0,0,0]"}}) {
    const std::uint64_t absent = hash_after_frames(without_effect(swinging(), c.effect));
    EXPECT_EQ(hash_after_frames(swinging({c.zero})), absent) << c.zero;
    EXPECT_NE(absent, hash_after_frames(swinging())) << c.effect << " did nothing, so that this says nothing";
  }
}

}  // namespace
}  // namespace weft
