// Scenes with colliders and air for the tests that hold the device against the mirrors.
#pragma once
#include <gtest/gtest.h>

#include "scenes.h"
#include "validated_pass.h"

namespace weft::test {

class ColliderGpuTest : public ValidatedPassTest {
 protected:
  void equals_its_mirror(const std::string& set, const char* solver, const char* precision,
                         const char* pass) {
    if (std::string(precision) == "f64" && !device().info().float64) return;
    const std::string text =
        "[cloth]\nresolution = 12\nheight = 0.8\norientation = \"horizontal\"\ncenter = [0, 0.9, "
        "0]\nimperfection = 0.01\n[[pins]]\nat = [0, 0]\n[gravity]\n" +
        set + fmt::format("[solver]\nprecision = \"{}\"\n", precision);
    const Model model = build_model(parse_scene(text, WEFT_SOURCE_DIR "/assets/scenes/test.toml").scene);
    EXPECT_GT(rows_of(model, solver, pass), 0u) << pass << " " << precision;
  }
};

inline const std::string kSolids =
    "[floor]\nheight = 0.5\nfriction = 0.3\nnormal = [0.2, 1, -0.1]\n"
    "[[capsules]]\na = [-0.3, 0.8, -0.2]\nb = [0.2, 0.9, 0.3]\nradius = 0.07\nfriction = 0.4\n"
    "[[boxes]]\nsize = [0.3, 0.2, 0.4]\nrotation = [10, 20, 30]\nfriction = 0.2\n"
    "keys = [{ time = 0, center = [0.2, 0.8, 0] }, { time = 0.1, center = [0.2, 1.2, 0], rotation = [0, 90, "
    "20] }]\n";
inline const std::string kMesh =
    "[floor]\nheight = 0.5\n[[meshes]]\nfile = \"../meshes/ring.obj\"\nresolution = 24\n"
    "friction = 0.3\nkeys = [{ time = 0, center = [0, 0.85, 0] }, { time = 0.1, center = [0, "
    "1.1, 0], rotation = [40, 0, 20] }]\n";
inline const std::string kWind =
    "[aerodynamics]\n[wind]\nvelocity = [4, 1, -3]\ngust = 0.5\nperiod = 0.3\nnoise = 3\n"
    "noise_scale = 0.3\nnoise_period = 0.02\nseed = 11\n";

}  // namespace weft::test
