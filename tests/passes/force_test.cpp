// The float form's force in double against laws: minus the energy's gradient, membrane stiffness, rigid
// motions, damping from its dissipation function, and the same bits however the rows are split.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>

#include "model/measures.h"
#include "model/springs.h"
#include "passes/force_sweep.h"
#include "passes/integrate.h"
#include "support/cloth.h"

namespace weft {
namespace {

using namespace testing_support;

Scene undamped(std::uint32_t columns, std::uint32_t rows, double bend_n_m) {
  Scene scene = bare_scene(columns, rows, 0.1);
  scene.material.damping_s = 0.0;
  scene.material.bend_n_m = bend_n_m;
  return scene;
}

/// Largest difference between m·acceleration and minus the numerical gradient of the energy [N].
double gradient_error_n(const Model& model, const State& state) {
  const std::vector<glm::dvec3> acc = acceleration(model, state);
  constexpr double kStep_m = 1e-6;
  double worst = 0.0;
  State moved = state;
  for (std::uint32_t p = 0; p < model.grid.count(); ++p) {
    for (int d = 0; d < 3; ++d) {
      moved.position[p][d] = state.position[p][d] + kStep_m;
      const double above = energy(model, moved).total();
      moved.position[p][d] = state.position[p][d] - kStep_m;
      const double below = energy(model, moved).total();
      moved.position[p][d] = state.position[p][d];
      const double force = -(above - below) / (2 * kStep_m);
      worst = std::max(worst, std::abs(acc[p][d] / model.inverse_mass(p) - force));
    }
  }
  return worst;
}

// The energy counts bending as its own quadratic form and springs by their own enumeration, so this checks
// the folding, the boundary weights and every existence rule. 1e-5 N of forces up to 100 N is the
// difference quotient's error.
TEST(Force, IsMinusTheGradientOfTheEnergy) {
  for (const auto& [columns, rows] : {std::pair{2u, 2u}, {2u, 5u}, {5u, 2u}, {3u, 3u}, {7u, 5u}}) {
    for (const double bend : {0.0, 0.5}) {
      for (const double flex : {0.0, 0.25}) {
        Scene scene = undamped(columns, rows, bend);
        scene.material.flex = flex;
        scene.material.shear_n_m = flex > 0 ? 300.0 : 0.0;
        scene.gravity = GravitySection{{1.0, -9.81, 2.0}};
        const Model model = build_model(scene);
        State state = start_state(model);
        shake(state, 0.03, 0.0, columns * 10 + rows);
        EXPECT_LE(gradient_error_n(model, state), 1e-5)
            << columns << " x " << rows << ", bend " << bend << ", flex " << flex;
      }
    }
  }
}

// Rayleigh's function R = ½Σ c·(dv along the spring)² is quadratic in v: its central difference is exact.
TEST(Force, DampingIsMinusTheGradientOfTheDissipation) {
  Scene scene = bare_scene(6, 5, 0.1);
  scene.material.bend_n_m = 0.1;
  const Model damped = build_model(scene);
  scene.material.damping_s = 0.0;
  const Model elastic = build_model(scene);
  State state = start_state(damped);
  shake(state, 0.03, 1.0, 3);
  const auto dissipation = [&](const State& s) {
    double sum = 0.0;
    for_each_spring(damped, [&](const SpringKind& kind, std::uint32_t a, std::uint32_t b, double weight) {
      const glm::dvec3 d = glm::normalize(s.position[b] - s.position[a]);
      const double along = glm::dot(d, s.velocity[b] - s.velocity[a]);
      sum += 0.5 * weight * kind.damping_n_s_m * along * along;
    });
    return sum;
  };
  const std::vector<glm::dvec3> with = acceleration(damped, state), without = acceleration(elastic, state);
  for (std::uint32_t p = 0; p < damped.grid.count(); ++p) {
    for (int d = 0; d < 3; ++d) {
      State faster = state, slower = state;
      faster.velocity[p][d] += 1.0;
      slower.velocity[p][d] -= 1.0;
      const double expected_n = -(dissipation(faster) - dissipation(slower)) / 2.0;
      EXPECT_NEAR((with[p][d] - without[p][d]) / damped.inverse_mass(p), expected_n, 1e-10) << p;
    }
  }
}

// A moved and turned flat cloth is at rest; one that turns as a whole has no damping force.
TEST(Force, IsZeroInRigidMotion) {
  Scene scene = bare_scene(9, 7, 0.1);
  scene.material.bend_n_m = 0.01;
  const Model model = build_model(scene);
  State state = start_state(model);
  const glm::dvec3 axis = glm::normalize(glm::dvec3(1, 2, -1)), spin = 0.7 * axis;
  for (std::size_t p = 0; p < state.position.size(); ++p) {
    const glm::dvec3 x = state.position[p];
    const glm::dvec3 turned = std::cos(0.8) * x + std::sin(0.8) * glm::cross(axis, x) +
                              (1 - std::cos(0.8)) * glm::dot(axis, x) * axis;
    state.position[p] = turned + glm::dvec3(3, -1, 2);
    state.velocity[p] = glm::cross(spin, turned) + glm::dvec3(0.1, 0.2, 0.3);
  }
  const std::vector<glm::dvec3> acc = acceleration(model, state);
  for (std::uint32_t p = 0; p < model.grid.count(); ++p)
    EXPECT_LE(glm::length(acc[p]) / model.inverse_mass(p), 1e-11) << p;
}

/// Energy per area of one interior cell under a homogeneous in-plane deformation: what a cloth gains when it
/// grows by one column and one row, less what it gains by each alone.
double cell_energy_j_m2(const glm::dmat2& deform) {
  const double a = 0.1;
  const auto total = [&](std::uint32_t columns, std::uint32_t rows) {
    const Model model = build_model(undamped(columns, rows, 0.0));
    State state = start_state(model);
    for (glm::dvec3& x : state.position) x = glm::dvec3(deform * glm::dvec2(x), 0.0);
    return energy(model, state).elastic_j;
  };
  return (total(8, 8) - total(8, 7) - total(7, 8) + total(7, 7)) / (a * a);
}

// C11 = k_s + k_d + 4k_f and C12 = C66 = k_d; with Y = 1000, φ = ¼, G = 3Y/8: 1125 and 375 N/m,
// that is Poisson's 1/3 and Young's Y.
TEST(Force, MembraneStiffnessIsIsotropic) {
  const Model model = build_model(undamped(4, 4, 0.0));
  const double ks = model.springs[kStructuralI].stiffness_n_m, kd = model.springs[kShearUp].stiffness_n_m;
  const double kf = model.springs[kFlexI].stiffness_n_m, e = 1e-5;
  const double c11 = 2 * cell_energy_j_m2(glm::dmat2(1 + e, 0, 0, 1)) / (e * e);
  const double both = 2 * cell_energy_j_m2(glm::dmat2(1 + e, 0, 0, 1 + e)) / (e * e);
  const double c66 = 2 * cell_energy_j_m2(glm::dmat2(1, e / 2, e / 2, 1)) / (e * e);  // γ = e
  EXPECT_NEAR(c11, ks + kd + 4 * kf, 0.1);
  EXPECT_NEAR(both / 2 - c11, kd, 0.1);
  EXPECT_NEAR(c66, kd, 0.1);
  EXPECT_NEAR(ks + kd + 4 * kf, 1125.0, 1e-9);
}

// Every band evaluates the springs that reach into it itself: the same bits for any split.
TEST(Force, BitsDoNotDependOnTheBands) {
  Scene scene = bare_scene(13, 23, 0.05);
  scene.material.bend_n_m = 1e-4;
  const Model model = build_model(scene);
  State state = start_state(model);
  shake(state, 0.02, 1.0, 11);
  std::array<std::vector<float>, 6> columns;
  for (int d = 0; d < 3; ++d) {
    for (const glm::dvec3& x : state.position) columns[d].push_back(static_cast<float>(x[d]));
    for (const glm::dvec3& v : state.velocity) columns[3 + d].push_back(static_cast<float>(v[d]));
  }
  const SweepTables<float> tables(model.grid, spring_rows<float>(model), {true, true, true});
  const auto load = [&](std::size_t j) {
    RowPointers<float> row;
    for (std::size_t d = 0; d < 6; ++d) row[d] = columns[d].data() + j * 13;
    return row;
  };
  const auto forces = [&](std::size_t band) {
    std::vector<float> all(3 * model.grid.count(), -1.0f);
    for (std::size_t begin = 0; begin < 23; begin += band) {
      ForceSweep<float> sweep(tables);
      sweep.run(begin, std::min<std::size_t>(begin + band, 23), load,
                [&](std::size_t j, const std::array<float*, 3>& f) {
                  for (std::size_t i = 0; i < 13; ++i)
                    for (std::size_t d = 0; d < 3; ++d) all[3 * (j * 13 + i) + d] = f[d][i];
                });
    }
    return all;
  };
  const std::vector<float> whole = forces(23);
  for (const std::size_t band : {1u, 2u, 3u, 8u}) EXPECT_EQ(forces(band), whole) << band;
}

// Two particles in one place: 1/|d| is guarded, nothing becomes infinite.
TEST(Force, OfCoincidentParticlesIsFinite) {
  const Model model = build_model(bare_scene(3, 3, 0.1));
  State state = start_state(model);
  for (glm::dvec3& x : state.position) x = glm::dvec3(1.0);
  for (const glm::dvec3& a : acceleration(model, state)) EXPECT_EQ(a, glm::dvec3(0.0));
}

}  // namespace
}  // namespace weft
