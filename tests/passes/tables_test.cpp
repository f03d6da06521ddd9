// The parameter block and the substep table hold the formulas' values in the documented places.
#include "passes/tables.h"

#include <gtest/gtest.h>

#include <atomic>

#include "core/error.h"
#include "passes/coefficients.h"
#include "passes/integrate.h"
#include "passes/parallel.h"
#include "support/cloth.h"

namespace weft {
namespace {

using namespace testing_support;

Scene full_scene() {
  Scene scene = bare_scene(5, 4, 0.1);
  scene.material.bend_n_m = 0.02;  // κ = 2 N/m
  scene.gravity = GravitySection{};
  scene.air = AirSection{0.4};  // α = 2 /s
  scene.wind = WindSection{{0.5, 0, 3}, 0.5, 0.4};
  scene.floor = FloorSection{-1.0, 0.3};
  scene.spheres = {{{0, 1, 0}, 0.25, {0, -2, 0}, 0.5}};
  scene.self_collision = SelfCollisionSection{0.01};
  return scene;
}

TEST(Params, SpringRowsFoldTheBending) {
  const shared::Params params = make_params(build_model(full_scene()));
  const double k = 562.5, kf = 46.875, a = 0.1;
  for (std::size_t direction = 0; direction < 2; ++direction) {
    for (std::size_t t = 0; t < 3; ++t) {
      const shared::vec4 inside = params.structural[direction * 6 + t];
      const shared::vec4 edge = params.structural[direction * 6 + 3 + t];
      EXPECT_FLOAT_EQ(inside.x, static_cast<float>(k + 4.0 * double(t)));
      EXPECT_FLOAT_EQ(edge.x, static_cast<float>(k / 2 + 2.0 * double(t)));
      EXPECT_FLOAT_EQ(inside.y, static_cast<float>(k * a));
      EXPECT_FLOAT_EQ(edge.y, static_cast<float>(k * a / 2));
      EXPECT_FLOAT_EQ(edge.z, inside.z / 2);
    }
    EXPECT_FLOAT_EQ(params.flex[direction * 2].x, static_cast<float>(kf - 2.0));
    EXPECT_FLOAT_EQ(params.flex[direction * 2 + 1].x, static_cast<float>(kf / 2 - 1.0));
    EXPECT_FLOAT_EQ(params.flex[direction * 2].y, static_cast<float>(kf * 2 * a));
  }
  EXPECT_FLOAT_EQ(params.shear.x, 375.0f);
  EXPECT_FLOAT_EQ(params.shear.y, static_cast<float>(375 * a * std::sqrt(2.0)));
}

TEST(Params, HoldTheScene) {
  const shared::Params params = make_params(build_model(full_scene()));
  EXPECT_EQ(params.nx, 5u);
  EXPECT_EQ(params.ny, 4u);
  EXPECT_FLOAT_EQ(params.inverse_mass_1_kg, 1.0f / (0.2f * 0.01f));
  EXPECT_EQ(params.gravity_m_s2, glm::vec3(0, -9.81f, 0));
  EXPECT_FLOAT_EQ(params.floor_height_m, -0.995f);
  EXPECT_FLOAT_EQ(params.floor_friction, 0.3f);
  EXPECT_EQ(params.sphere_count, 1u);
  EXPECT_EQ(params.row_stride, 5u);
}

TEST(Params, TooManySpheresAreRefused) {
  Scene scene = full_scene();
  scene.spheres.resize(shared::kMaxSpheres + 1, scene.spheres[0]);
  EXPECT_THROW(make_params(build_model(scene)), Error);
}

TEST(SubstepTable, RowsAreLaidOutAsDocumented) {
  const Model model = build_model(full_scene());
  std::vector<shared::vec4> table{{9, 9, 9, 9}};
  const std::vector<KickDrift> rows{{0.005, 0.01, 0.1, 0.1}, {0.005, 0.0, 0.2, 0.2}};
  fill_substep_rows(model, rows, table);
  ASSERT_EQ(table.size(), 10u);
  // wind(0.1) = velocity·1.5 at a quarter of the period; α = 2
  EXPECT_FLOAT_EQ(table[0].x, 1.5f);
  EXPECT_FLOAT_EQ(table[0].z, 9.0f);
  EXPECT_FLOAT_EQ(table[0].w, static_cast<float>(1 - std::exp(-0.01)));
  EXPECT_FLOAT_EQ(table[1].x, static_cast<float>((1 - std::exp(-0.01)) / 2));
  EXPECT_FLOAT_EQ(table[1].y, 0.01f);
  EXPECT_FLOAT_EQ(table[2].y, static_cast<float>(1.0 - 2 * 0.11));
  EXPECT_FLOAT_EQ(table[2].w, 0.255f);
  EXPECT_FLOAT_EQ(table[3].y, -0.02f);
  EXPECT_FLOAT_EQ(table[3].w, 0.5f);
  EXPECT_FLOAT_EQ(table[4].y, -2.0f);
  EXPECT_EQ(table[6].y, 0.0f);  // the closing kick does not drift
  EXPECT_EQ(table[8].y, 0.0f);  // nor does the sphere travel
  EXPECT_FLOAT_EQ(table[7].y, 0.6f);
}

TEST(SubstepTable, WithoutAirTheKickIsItsLength) {
  Scene scene = full_scene();
  scene.wind.reset();
  scene.air.reset();
  const SubstepRow<double> row = substep_row_exact(build_model(scene), {0.25, 0.5, 0.0, 0.0});
  EXPECT_EQ(row.loss, 0.0);
  EXPECT_EQ(row.gain, 0.25);
  EXPECT_EQ(row.alpha_wind, glm::dvec3(0.0));
}

TEST(Constants, FollowTheScene) {
  const auto values = [](const Scene& scene) {
    std::string bits;
    for (const Constant& constant : integrate.constants(build_model(scene)))
      bits += constant.value ? '1' : '0';
    return bits;
  };
  EXPECT_EQ(values(full_scene()), "1111111110");  // no pins
  Scene bare = bare_scene(3, 3, 0.1);
  bare.material = {.preset = "", .shear_n_m = 0.0, .flex = 0.0, .damping_s = 0.0};
  EXPECT_EQ(values(bare), "0000000000");
  bare.pins = {{{0, 0}, 0.05}};
  bare.air = AirSection{0.0};
  bare.wind = WindSection{{1, 0, 0}, 0, 0};  // wind without drag does nothing
  EXPECT_EQ(values(bare), "0000000001");
}

TEST(State, SurvivesTheBuffers) {
  const Model model = build_model(full_scene());
  State state = start_state(model);
  shake(state, 0.1, 1.0, 1);
  HostBuffers<double> buffers;
  load_state(model, state, buffers);
  EXPECT_EQ(buffers[BufferId::position][0].w, 4.0);  // a free corner has a quarter of the mass
  const State back = store_state(buffers, 1.5);
  EXPECT_EQ(back.position, state.position);
  EXPECT_EQ(back.velocity, state.velocity);
  EXPECT_EQ(back.time_s, 1.5);
}

// A pinned particle keeps its place and velocity bit for bit, and passes w on.
TEST(Integrate, LeavesPinnedParticles) {
  Scene scene = full_scene();
  scene.pins = {{{0, 0}, 0.11}};
  const Model model = build_model(scene);
  State state = start_state(model);
  shake(state, 0.1, 1.0, 2);
  HostBuffers<float> buffers;
  load_state(model, state, buffers);
  const KickDrift row{0.001, 0.001, 0.0, 0.0};
  integrate.mirror_f32({model, integrate.constants(model), row, 0}, buffers);
  for (std::size_t p = 0; p < model.grid.count(); ++p) {
    const bool pinned = model.relative_inverse_mass[p] == 0.0;
    EXPECT_EQ(buffers[BufferId::position_next][p] == buffers[BufferId::position][p], pinned) << p;
    EXPECT_EQ(buffers[BufferId::velocity_next][p] == buffers[BufferId::velocity][p], pinned) << p;
    EXPECT_EQ(buffers[BufferId::position_next][p].w, buffers[BufferId::position][p].w);
  }
}

TEST(Parallel, CoversEveryRowOnce) {
  for (const std::uint32_t rows : {1u, 7u, 64u, 1000u}) {
    std::vector<std::atomic<int>> visits(rows);
    parallel_rows(rows, 4096, [&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t r = begin; r < end; ++r) ++visits[r];
    });
    for (const auto& count : visits) EXPECT_EQ(count, 1);
  }
}

}  // namespace
}  // namespace weft
