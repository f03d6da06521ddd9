// Warp and weft apart: each direction follows its own closed form, and equal values are the isotropic cloth.
#include <gtest/gtest.h>

#include "closed_forms.h"
#include "model/step_bound.h"
#include "plan/plan.h"

namespace weft::closed_forms {
namespace {

Runner on_cpu(const char* solver, const char* precision) {
  return {&find_solver(solver),
          [=](const Model& model, const State& start, int frames, double frame_s, std::uint32_t substeps) {
            return testing_support::run_frames(model, start, solver, precision, frames, frame_s, substeps);
          }};
}

/// Stretch [m] of a strip of eight cells, hung by its first line and pulled along the warp (j) or the weft.
double strip_stretch_m(const Runner& runner, bool along_warp) {
  constexpr double kLength_m = 0.8;
  Scene scene = along_warp ? bare_scene(3, 9, kLength_m / 8) : bare_scene(9, 3, kLength_m / 8);
  scene.material.flex = 0.0;
  scene.material.shear_n_m = 0.0;
  scene.material.membrane_warp_n_m = 160.0;
  scene.material.membrane_weft_n_m = 80.0;
  scene.gravity = GravitySection{along_warp ? glm::dvec3(0, -9.81, 0) : glm::dvec3(9.81, 0, 0)};
  const Model model =
      pin_where(build_model(scene), [=](auto i, auto j) { return (along_warp ? j : i) == 0; });
  const State rest = crept(runner, model, 76.0, 0.8);
  const glm::dvec3 ends = along_warp
                              ? rest.position[1] - rest.position[model.grid.index(1, 8)]
                              : rest.position[model.grid.index(8, 1)] - rest.position[model.grid.index(0, 1)];
  return (along_warp ? ends.y : ends.x) - kLength_m;
}

// ρgL²/(2k_s) with k_s = ¾ of the direction's own membrane stiffness. XPBD's one sweep leaves 1.2 %.
TEST(Anisotropy, EachDirectionStretchesByItsOwnStiffness) {
  const double weight = 0.2 * 9.81 * 0.8 * 0.8 / 2;
  for (const auto& [solver, allowed] : {std::pair{"leapfrog", 1e-5}, {"xpbd", 0.02}}) {
    const Runner runner = on_cpu(solver, "f64");
    EXPECT_NEAR(strip_stretch_m(runner, true), weight / 120.0, allowed * weight / 120.0) << solver;
    EXPECT_NEAR(strip_stretch_m(runner, false), weight / 60.0, allowed * weight / 60.0) << solver;
  }
}

/// Tip drop over tip reach of a cantilever of 24 cells that reaches out along the warp (j) or the weft.
double cantilever_slope(const Runner& runner, bool along_warp, double bend_warp_n_m, double bend_weft_n_m) {
  constexpr std::uint32_t kLine = 26;
  constexpr double kLength_m = 0.5, kSpacing_m = kLength_m / 24.5;
  Scene scene = along_warp ? bare_scene(3, kLine, kSpacing_m) : bare_scene(kLine, 3, kSpacing_m);
  scene.cloth.orientation = Orientation::horizontal;
  scene.gravity = GravitySection{};
  scene.material.flex = 0.0;
  scene.material.shear_n_m = 0.0;
  scene.material.membrane_n_m = 2000.0;
  scene.material.bend_warp_n_m = bend_warp_n_m;
  scene.material.bend_weft_n_m = bend_weft_n_m;
  const Model model = pin_where(build_model(scene), [=](auto i, auto j) { return (along_warp ? j : i) < 2; });
  const double slowest_1_s =
      3.516 / (kLength_m * kLength_m) * std::sqrt((along_warp ? bend_warp_n_m : bend_weft_n_m) / 0.2);
  const State rest = crept(runner, model, 2 * slowest_1_s, 12 / slowest_1_s);
  const auto at = [&](std::uint32_t k) {
    return rest.position[along_warp ? model.grid.index(1, k) : model.grid.index(k, 1)];
  };
  const glm::dvec3 reach = at(kLine - 1) - at(1);
  return -reach.y / ((along_warp ? reach.z : reach.x) + 0.5 * kSpacing_m);
}

// The elastica at Γ = ρ g L³/B: 1 along the warp, 5 along the weft, of one and the same cloth.
TEST(Anisotropy, EachDirectionBendsByItsOwnRigidity) {
  const double load = 0.2 * 9.81 * 0.125;
  const Runner runner = on_cpu("leapfrog", "f64");
  EXPECT_NEAR(cantilever_slope(runner, true, load / 1.0, load / 5.0), 0.12456, 0.01 * 0.12456);
  EXPECT_NEAR(cantilever_slope(runner, false, load / 1.0, load / 5.0), 0.58572, 0.01 * 0.58572);
}

// Absent and equal are one cloth: the same plan, bytes and bits, with XPBD too.
TEST(Anisotropy, EqualDirectionsAreTheIsotropicCloth) {
  for (const char* solver : {"leapfrog", "xpbd"}) {
    Scene plain = bare_scene(9, 9, 0.05);
    plain.material.bend_n_m = 1e-4;
    plain.pins = {{{0.0, 0.0}, 0.05}};
    plain.gravity = GravitySection{};
    Scene equal = plain;
    equal.material.membrane_warp_n_m = equal.material.membrane_weft_n_m = plain.material.membrane_n_m;
    equal.material.bend_warp_n_m = equal.material.bend_weft_n_m = 1e-4;
    const Model a = build_model(plain), b = build_model(equal);
    EXPECT_EQ(to_json(compile_plan(a, find_solver(solver)), a),
              to_json(compile_plan(b, find_solver(solver)), b));
    const auto end = [&](const Model& m) {
      return state_hash(testing_support::run_frames(m, start_state(m), solver, "f32", 3, 1.0 / 60, 60));
    };
    EXPECT_EQ(end(a), end(b)) << solver;
    equal.material.membrane_weft_n_m = 500.0;
    EXPECT_NE(end(a), end(build_model(equal))) << solver;
  }
}

// The stiffer direction decides, so that a cloth with one stiff thread never steps as if it were soft.
TEST(Anisotropy, TheStepBoundCountsBothDirections) {
  Scene scene = bare_scene(9, 9, 0.05);
  const double isotropic = build_model(scene).bound.lambda_1_s2;
  scene.material.shear_n_m = scene.material.shear();
  scene.material.membrane_warp_n_m = 4000.0;
  const double warp = build_model(scene).bound.lambda_1_s2;
  scene.material.membrane_weft_n_m = 4000.0;
  const double both = build_model(scene).bound.lambda_1_s2;
  EXPECT_GT(warp, 1.5 * isotropic);
  EXPECT_GT(both, warp);
}

}  // namespace
}  // namespace weft::closed_forms
