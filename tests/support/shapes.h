// Cloths of one sheet in shapes that a simulation seldom reaches, and what passes that move nobody make of
// them.
#pragma once
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <random>
#include <string>
#include <vector>

#include "model/measures.h"
#include "passes/passes.h"
#include "passes/tables.h"
#include "plan/buffers.h"
#include "scene/reader.h"

namespace weft {

inline constexpr KickDrift kNoTime;

inline Model sheet_model(int columns, int rows, double thickness_cells, const std::string& more = "") {
  return build_model(
      parse_scene(fmt::format("[cloth]\nwidth = {}\nheight = {}\nresolution = {}\n{}"
                              "[self_collision]\nthickness = {}\n",
                              0.1 * (columns - 1), 0.1 * (rows - 1), columns, more, 0.1 * thickness_cells),
                  "sheet.toml")
          .scene);
}

/// A shape of a cloth whose cells are 0.1 m: moves the particles of its start.
struct Shape {
  std::string name;
  std::function<void(const Model&, std::mt19937_64&, std::vector<glm::dvec3>&)> apply;
};

inline void add_noise(double noise_m, std::mt19937_64& random, std::vector<glm::dvec3>& x) {
  std::normal_distribution<double> normal(0.0, noise_m);
  for (glm::dvec3& at : x) at += glm::dvec3(normal(random), normal(random), normal(random));
}

/// Rolled up along i by `turn` [rad] a cell, with noise.
inline Shape rolled(double turn, double noise_cells) {
  return {fmt::format("rolled by {}, noise {}", turn, noise_cells),
          [=](const Model& model, std::mt19937_64& random, std::vector<glm::dvec3>& x) {
            const double a = model.grid.spacing_m;
            for (std::uint32_t j = 0; j < model.grid.ny; ++j) {
              double across = 0, up = 0;
              for (std::uint32_t i = 0; i < model.grid.nx; ++i) {
                glm::dvec3& at = x[model.grid.index(i, j)];
                at = {across, at.y, at.z + up};
                across += a * (std::cos(turn * i) + 0.1);
                up += a * std::sin(turn * i);
              }
            }
            add_noise(noise_cells * a, random, x);
          }};
}

/// Flat and even, with edges so many cells long and so much of a row's pushed along it from one to the next:
/// at the bounds of what is smooth (docs/float-form.md "Folds"), which `noise_cells` oversteps here and
/// there.
inline Shape drawn(double along, double down, double shear, double noise_cells) {
  return {fmt::format("drawn by {} and {}, shear {}, noise {}", along, down, shear, noise_cells),
          [=](const Model& model, std::mt19937_64& random, std::vector<glm::dvec3>& x) {
            const double a = model.grid.spacing_m;
            for (std::uint32_t j = 0; j < model.grid.ny; ++j)
              for (std::uint32_t i = 0; i < model.grid.nx; ++i)
                x[model.grid.index(i, j)] = {a * (along * i + shear * j), 0.0, a * down * j};
            add_noise(noise_cells * a, random, x);
          }};
}

/// Creased along the cells' diagonals, alternately up and down, as sharp as a line of cells allows.
inline Shape creased(double depth_cells, double noise_cells) {
  return {fmt::format("creased by {}, noise {}", depth_cells, noise_cells),
          [=](const Model& model, std::mt19937_64& random, std::vector<glm::dvec3>& x) {
            const double a = model.grid.spacing_m;
            for (std::uint32_t p = 0; p < x.size(); ++p) {
              const std::uint32_t line = p % model.grid.nx + p / model.grid.nx;
              x[p].y += depth_cells * a * (line % 2);
              x[p].x *= 0.7, x[p].z *= 0.7;
            }
            add_noise(noise_cells * a, random, x);
          }};
}

inline Shape scattered() {
  return {"scattered", [](const Model& model, std::mt19937_64& random, std::vector<glm::dvec3>& x) {
            std::uniform_real_distribution<double> any(-2.0 * model.grid.spacing_m,
                                                       2.0 * model.grid.spacing_m);
            for (glm::dvec3& at : x) at = {any(random), any(random), any(random)};
          }};
}

/// Some of its coordinates are no numbers, infinite or beyond every cell of the grid.
inline Shape unsound() {
  return {"unsound", [](const Model&, std::mt19937_64& random, std::vector<glm::dvec3>& x) {
            const double bad[] = {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e9, -1e9, 3e38, 1e20};
            std::uniform_int_distribution<std::size_t> which(0, 6), axis(0, 2), place(0, x.size() - 1);
            for (std::size_t k = 0; k < 1 + x.size() / 40; ++k)
              x[place(random)][static_cast<int>(axis(random))] = bad[which(random)];
          }};
}

inline std::vector<Shape> shapes() {
  return {rolled(0.0, 0.0),
          rolled(0.0, 0.05),
          rolled(0.2, 0.02),
          rolled(0.6, 0.08),
          rolled(2.2, 0.25),
          creased(0.6, 0.0),
          creased(1.2, 0.05),
          scattered(),
          unsound(),
          drawn(0.955, 0.955, 0.2, 0.002),
          drawn(0.955, 0.955, -0.2, 0.002),
          drawn(0.96, 1.15, 0.1, 0.003),
          drawn(3.0, 0.96, 0.05, 0.003),
          drawn(0.8, 0.8, 0.0, 0.002),
          rolled(0.015, 0.001)};
}

/// The buffers as they are before the lists are made: what moves nobody has run.
inline HostBuffers<float> buffers_of(const Model& model, const Plan& plan, const Shape& shape,
                                     std::uint64_t seed) {
  State state = start_state(model);
  std::mt19937_64 random(seed);
  shape.apply(model, random, state.position);
  HostBuffers<float> buffers;
  size_buffers(plan, model, buffers);
  load_state(model, state, buffers);
  return buffers;
}

inline void run_mirror(const Pass& pass, const Model& model, HostBuffers<float>& buffers) {
  const Constants constants = pass.constants(model);
  pass.mirror_f32({.model = model, .constants = constants, .row = kNoTime}, buffers);
}

}  // namespace weft
