// A synthetic cloth for pictures: no simulation, the same on every device.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "model/model.h"
#include "render/offscreen.h"

namespace weft::test {

/// A vertical sheet of 1.2 m × 0.9 m with pins in the top corners, over a floor, beside a sphere.
inline Scene sheet_scene() {
  Scene scene;
  scene.title = "sheet";
  scene.cloth.width_m = 1.2;
  scene.cloth.height_m = 0.9;
  scene.cloth.resolution = 17;  // cells of several pixels, so that drivers agree on them
  scene.cloth.center_m = {0.0, 0.75, 0.0};
  scene.pins = {PinSection{{0.0, 0.0}, 0.02}, PinSection{{1.0, 0.0}, 0.02}};
  scene.gravity = GravitySection{};
  scene.floor = FloorSection{0.0, 0.3};
  scene.spheres = {SphereSection{{0.55, 0.2, 0.55}, 0.2, {0.0, 0.0, 0.0}, 0.3}};
  return scene;
}

/// The model's start with a wave across it, growing towards the lower edge.
inline State waved(const Model& model) {
  State state = start_state(model);
  for (std::uint32_t j = 0; j < model.grid.ny; ++j)
    for (std::uint32_t i = 0; i < model.grid.nx; ++i) {
      const double u = double(i) / (model.grid.nx - 1), s = double(j) / (model.grid.ny - 1);
      state.position[model.grid.index(i, j)].z += 0.16 * s * std::sin(3.0 * std::numbers::pi * u + 2.0 * s);
    }
  return state;
}

/// Small enough for a golden file, and drawn alike on every device: one sample a pixel.
inline RenderOptions small_picture() {
  RenderOptions options;
  options.width = 240;
  options.height = 136;
  options.samples = 1;
  return options;
}

/// How two pictures of one size differ, in steps of 1/255.
struct Difference {
  double mean = 0.0;       ///< mean absolute difference over the colour channels
  double differing = 0.0;  ///< share of pixels with a channel more than 24 steps apart
};

inline Difference difference(const Picture& a, const Picture& b) {
  Difference result;
  std::size_t apart = 0;
  const std::size_t pixels = std::size_t{a.width} * a.height;
  for (std::size_t p = 0; p < pixels; ++p) {
    int most = 0;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const int d = std::abs(int(a.rgba[4 * p + channel]) - int(b.rgba[4 * p + channel]));
      result.mean += d;
      most = std::max(most, d);
    }
    apart += most > 24 ? 1 : 0;
  }
  result.mean /= 3.0 * double(pixels);
  result.differing = double(apart) / double(pixels);
  return result;
}

}  // namespace weft::test
