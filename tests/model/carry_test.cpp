// Carrying a cloth over to another grid: what the interpolation must reproduce exactly, and how far off it
// may be elsewhere.
#include "model/carry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

namespace weft {
namespace {

Scene cloth(std::uint32_t resolution) {
  Scene scene;
  scene.cloth.resolution = resolution;
  scene.pins = {{.at = {0.0, 0.0}}, {.at = {1.0, 0.0}}};
  return scene;
}

/// A state displaced from the start by `field` of the flat cloth's fractions; velocities follow it too.
template <class Field>
State displaced(const Model& model, Field&& field) {
  State state = start_state(model);
  for (std::uint32_t j = 0; j < model.grid.ny; ++j)
    for (std::uint32_t i = 0; i < model.grid.nx; ++i) {
      const std::uint32_t p = model.grid.index(i, j);
      if (model.relative_inverse_mass[p] == 0.0) continue;
      const glm::dvec3 u =
          field(static_cast<double>(i) / (model.grid.nx - 1), static_cast<double>(j) / (model.grid.ny - 1));
      state.position[p] += u;
      state.velocity[p] = 2.0 * u;
    }
  return state;
}

glm::dvec3 wave(double s, double t) {
  return {0.02 * std::sin(5.0 * t), 0.05 * std::cos(4.0 * s), 0.1 * std::sin(6.0 * s + 3.0 * t)};
}

double largest_error(const Model& model, const State& state, const State& expected) {
  double worst = 0.0;
  for (std::uint32_t p = 0; p < model.grid.count(); ++p)
    if (model.relative_inverse_mass[p] > 0.0)
      worst = std::max(worst, glm::length(state.position[p] - expected.position[p]));
  return worst;
}

TEST(Carry, SameGridKeepsEveryBit) {
  const Model model = build_model(cloth(23));
  State state = displaced(model, wave);
  state.time_s = 1.25;
  Scene stiffer = cloth(23);
  stiffer.material.membrane_n_m = 5000.0;
  const State carried = carry_state(model, state, build_model(stiffer));
  EXPECT_EQ(carried.position, state.position);
  EXPECT_EQ(carried.velocity, state.velocity);
  EXPECT_EQ(carried.time_s, 1.25);
}

// Catmull–Rom with straight ends reproduces every affine field, so a cloth that was moved, turned or
// stretched evenly stays exactly that, up to rounding (1e-12 of a metre).
TEST(Carry, AffineFieldsAreExact) {
  Scene from = cloth(17), to = cloth(64);
  from.pins.clear();
  to.pins.clear();
  const auto affine = [](double s, double t) {
    return glm::dvec3(0.3 - 0.2 * s, 0.1 * t, 0.4 * s - 0.7 * t + 0.05);
  };
  for (const std::uint32_t resolution : {16u, 31u, 64u, 129u}) {
    to.cloth.resolution = resolution;
    const Model coarse = build_model(from), fine = build_model(to);
    const State carried = carry_state(coarse, displaced(coarse, affine), fine);
    const State expected = displaced(fine, affine);
    for (std::uint32_t p = 0; p < fine.grid.count(); ++p) {
      EXPECT_LT(glm::length(carried.position[p] - expected.position[p]), 1e-12) << p;
      EXPECT_LT(glm::length(carried.velocity[p] - expected.velocity[p]), 1e-12) << p;
    }
  }
}

// The error of a cubic through samples of a wave of amplitude A and wave number k at spacing h is of order
// A·(k·h)³ inside and A·(k·h)²/8 in the end cells, where only straight lines are known beyond: with A = 0.1,
// k = 6.7 and h = 1/39 that is 0.1·0.0295/8 = 3.7e-4 m.
TEST(Carry, SmoothShapeIsKept) {
  Scene free_from = cloth(40), free_to = cloth(128);
  free_from.pins.clear();
  free_to.pins.clear();
  const Model coarse = build_model(free_from), fine = build_model(free_to);
  const State carried = carry_state(coarse, displaced(coarse, wave), fine);
  EXPECT_LT(largest_error(fine, carried, displaced(fine, wave)), 4e-4);
  const State back = carry_state(fine, carried, coarse);
  EXPECT_LT(largest_error(coarse, back, displaced(coarse, wave)), 4e-4);
}

// Doubling the resolution of what is carried divides the error by at least 4 (second order in the end cells).
TEST(Carry, ErrorFallsWithTheGrid) {
  const auto error_from = [](std::uint32_t resolution) {
    Scene from = cloth(resolution), to = cloth(200);
    from.pins.clear();
    to.pins.clear();
    const Model coarse = build_model(from), fine = build_model(to);
    return largest_error(fine, carry_state(coarse, displaced(coarse, wave), fine), displaced(fine, wave));
  };
  EXPECT_LT(error_from(41), error_from(21) / 3.5);
  EXPECT_LT(error_from(81), error_from(41) / 3.5);
}

TEST(Carry, PinsEndExactlyOnTheirPlacesAndRest) {
  const Model coarse = build_model(cloth(24));
  const State state = displaced(coarse, wave);
  for (const std::uint32_t resolution : {16u, 63u, 256u}) {
    const Model fine = build_model(cloth(resolution));
    const State carried = carry_state(coarse, state, fine), start = start_state(fine);
    std::uint32_t pins = 0;
    for (std::uint32_t p = 0; p < fine.grid.count(); ++p) {
      if (fine.relative_inverse_mass[p] > 0.0) continue;
      EXPECT_EQ(carried.position[p], start.position[p]);
      EXPECT_EQ(carried.velocity[p], glm::dvec3(0.0));
      ++pins;
    }
    EXPECT_GT(pins, 1u);
  }
}

TEST(Carry, APinMadeElsewhereStaysThere) {
  const Model before = build_model(cloth(24));
  State state = displaced(before, wave);
  Scene pinned = cloth(24);
  pinned.pins.push_back({.at = {11.0 / 23.0, 1.0}, .radius_m = 0.03});  // particle (11, 23) alone
  const Model with_pin = build_model(pinned);
  state = carry_state(before, state, with_pin);
  pinned.cloth.resolution = 95;
  pinned.pins.back().radius_m = 0.008;  // particle (45, 94): 45/94 is nearest to 11/23
  const Model fine = build_model(pinned);
  const State carried = carry_state(with_pin, state, fine);
  const std::uint32_t old = with_pin.grid.index(11, 23), now = fine.grid.index(45, 94);
  ASSERT_EQ(fine.relative_inverse_mass[now], 0.0);
  // It keeps the displacement of the pinned particle nearest to it.
  const glm::dvec3 moved_before = state.position[old] - start_state(with_pin).position[old];
  const glm::dvec3 moved = carried.position[now] - start_state(fine).position[now];
  EXPECT_GT(glm::length(moved_before), 0.02) << "the pin is not on its place in the flat cloth";
  EXPECT_LT(glm::length(moved - moved_before), 1e-12);
  EXPECT_EQ(carried.velocity[now], glm::dvec3(0.0));
}

TEST(Carry, TheSmallestGridIsEnough) {
  Scene from = cloth(2), to = cloth(9);
  from.pins.clear();
  to.pins.clear();
  const auto affine = [](double s, double t) { return glm::dvec3(s, t, s + t); };
  const Model two = build_model(from), nine = build_model(to);
  const State carried = carry_state(two, displaced(two, affine), nine);
  EXPECT_LT(largest_error(nine, carried, displaced(nine, affine)), 1e-12);
}

}  // namespace
}  // namespace weft
