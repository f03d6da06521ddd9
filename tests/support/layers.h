// Scenes of many layers for self-collision: a strip folded to and fro, a sheet folded in half, a sheet that a
// sphere presses on the floor.
#pragma once
#include <fmt/format.h>

#include <cmath>
#include <string>

#include "model/model.h"
#include "scene/reader.h"

namespace weft::testing_support {

/// A scene that begins in a state of its own.
struct LayeredScene {
  Model model;
  State start;
};

inline constexpr const char* kLayerMaterial =
    "[material]\ndensity = 0.2\nmembrane = 300.0\nflex = 0\nbend = 1e-6\ndamping = "
    "2e-4\n[gravity]\n[air]\ndrag = 0.1\n"
    "[floor]\nfriction = 0.3\n";

inline Model layered_model(const std::string& cloth, double thickness_m, const std::string& more) {
  return build_model(parse_scene(cloth + kLayerMaterial +
                                     fmt::format("[self_collision]\nthickness = {}\n", thickness_m) + more,
                                 "layers.toml")
                         .scene);
}

/// A strip `columns` wide, folded to and fro so that `layers` of as many rows each lie above one another,
/// half a cell apart, the lowest 1.5 cells above the floor. Cells are 1/(columns − 1) m × `width_m`.
inline LayeredScene folded_strip(std::uint32_t columns, std::uint32_t layers, double width_m,
                                 const std::string& more = "") {
  const double a = width_m / (columns - 1);
  const std::uint32_t rows = columns * layers;
  const Model model = layered_model(
      fmt::format("[cloth]\nwidth = {}\nheight = {}\nresolution = {}\norientation = \"horizontal\"\n",
                  width_m, a * (rows - 1), columns),
      0.25 * a, more);
  State state = start_state(model);
  const double rise = 0.3 * a, turn = std::sqrt(a * a - rise * rise);
  for (std::uint32_t j = 0; j < model.grid.ny; ++j)
    for (std::uint32_t i = 0; i < model.grid.nx; ++i) {
      const std::uint32_t layer = j / columns, row = j % columns;
      const double along = layer % 2 == 0 ? row * a : turn + (columns - 1 - row) * a;
      state.position[model.grid.index(i, j)] = {i * a - width_m / 2, 1.5 * a + layer * rise,
                                                along - width_m / 2};
    }
  return {model, state};
}

/// A square sheet folded flat on itself: its right half half a cell above the left, shifted by a third of a
/// cell.
inline LayeredScene folded_sheet(std::uint32_t columns, double height_m, const std::string& more = "") {
  const double a = 1.0 / (columns - 1);
  const Model model = layered_model(
      fmt::format("[cloth]\nresolution = {}\norientation = \"horizontal\"\n", columns), 0.25 * a, more);
  State state = start_state(model);
  for (glm::dvec3& x : state.position) {
    x.y = height_m;
    if (x.x > 1e-9) x = {-x.x + a / 3, height_m + 0.5 * a, x.z};
  }
  return {model, state};
}

}  // namespace weft::testing_support
