// What the simulation tests share: scenes by number or text, and bits side by side.
#pragma once
#include <gtest/gtest.h>

#include <bit>
#include <string>

#include "model/measures.h"
#include "scene/reader.h"
#include "solvers/solver.h"

namespace weft::test {

inline Model scene_model(const std::string& name, const SceneOverrides& overrides = {}) {
  return build_model(load_scene(find_scene(name), overrides).scene);
}

/// A small cloth that has every effect there is, a moving sphere included.
inline Model full_model(const std::string& more = "") {
  return build_model(parse_scene(R"(
[cloth]
resolution = 24
height = 0.8
center = [0.0, 0.9, 0.0]
imperfection = 0.01
[material]
bend = 1e-5
[[pins]]
at = [0.0, 0.0]
[gravity]
[air]
drag = 0.2
[wind]
velocity = [0.5, 0.0, 3.0]
gust = 0.5
period = 0.7
[floor]
height = 0.52
friction = 0.4
[[spheres]]
center = [0.1, 0.9, 0.25]
radius = 0.2
velocity = [0.0, 0.0, -1.0]
friction = 0.3
)" + more,
                                 "full.toml")
                         .scene);
}

/// Positions and velocities bit by bit; double holds every float, and −0 equals +0.
inline void expect_same(const State& got, const State& expected, const std::string& what) {
  ASSERT_EQ(got.position.size(), expected.position.size()) << what;
  for (std::size_t p = 0; p < got.position.size(); ++p) {
    ASSERT_EQ(got.position[p], expected.position[p]) << what << ": position of particle " << p;
    ASSERT_EQ(got.velocity[p], expected.velocity[p]) << what << ": velocity of particle " << p;
  }
}

}  // namespace weft::test
