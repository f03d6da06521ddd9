// What the renderer makes and draws: only what the scene has, light and shadow where they belong.
#include "render/renderer.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "gpu_fixture.h"
#include "render/sheet.h"
#include "solvers/solver.h"

namespace weft::test {
namespace {

class RendererTest : public GpuTest {
 protected:
  static bool has(const Renderer& renderer, std::string_view name) {
    const auto names = renderer.pipelines();
    return std::find(names.begin(), names.end(), name) != names.end();
  }
  static Picture draw(const Scene& scene, const RenderOptions& options) {
    const Model model = build_model(scene);
    return OffscreenRenderer(device(), model, options).draw(waved(model));
  }
};

struct Color {
  int red = 0, green = 0, blue = 0;
  int sum() const { return red + green + blue; }
};

/// The pixel in which a point of the world is seen.
Color color_at(const Picture& picture, const Camera& camera, const glm::dvec3& p) {
  const glm::vec4 clip = camera.clip(double(picture.width) / picture.height) * glm::vec4(p, 1.0);
  const auto pixel = [](float ndc, std::uint32_t size) {
    return static_cast<std::size_t>(std::clamp((0.5f * ndc + 0.5f) * float(size), 0.0f, float(size) - 1.0f));
  };
  const std::size_t x = pixel(clip.x / clip.w, picture.width), y = pixel(clip.y / clip.w, picture.height);
  const std::uint8_t* rgba = &picture.rgba[4 * (y * picture.width + x)];
  return {rgba[0], rgba[1], rgba[2]};
}

TEST_F(RendererTest, MakesPipelinesOnlyForWhatTheSceneHas) {
  Scene scene = sheet_scene();
  const Model full = build_model(scene);
  OffscreenRenderer everything(device(), full, small_picture());
  everything.draw(waved(full));
  EXPECT_TRUE(has(everything.renderer(), "floor"));
  EXPECT_TRUE(has(everything.renderer(), "balls"));
  EXPECT_FALSE(has(everything.renderer(), "wireframe"));
  EXPECT_FALSE(has(everything.renderer(), "cloth heat"));

  scene.floor.reset();
  scene.spheres.clear();
  scene.pins.clear();
  const Model bare = build_model(scene);
  OffscreenRenderer alone(device(), bare, small_picture());
  alone.draw(waved(bare));
  EXPECT_EQ(alone.renderer().pipelines(), (std::vector<std::string_view>{"shadow of cloth", "cloth", "sky"}));
  EXPECT_EQ(alone.counts().draws, 3u);
}

TEST_F(RendererTest, FlatShadingDrawsExactlyHalfOfTheTriangles) {
  const Model model = build_model(sheet_scene());
  const std::uint64_t cells = std::uint64_t{model.grid.nx - 1} * (model.grid.ny - 1);
  RenderOptions options = small_picture();
  OffscreenRenderer smooth(device(), model, options);
  smooth.draw(waved(model));
  EXPECT_EQ(smooth.counts().cloth_triangles, 2 * cells);
  options.look.shading = Shading::flat;
  OffscreenRenderer flat(device(), model, options);
  flat.draw(waved(model));
  EXPECT_EQ(flat.counts().cloth_triangles, cells);
  options.look.wireframe = true;
  OffscreenRenderer wire(device(), model, options);
  wire.draw(waved(model));
  EXPECT_EQ(wire.counts().cloth_triangles, 0u);
  EXPECT_EQ(wire.counts().cloth_lines, 3 * cells + (model.grid.nx - 1) + (model.grid.ny - 1));
}

TEST_F(RendererTest, AStrideDrawsEveryThatManythParticleAndTheEdges) {
  const Model model = build_model(sheet_scene());
  RenderOptions options = small_picture();
  OffscreenRenderer whole(device(), model, options);
  const Picture every = whole.draw(waved(model));
  options.look.stride = 2;
  OffscreenRenderer coarse(device(), model, options);
  const Picture second = coarse.draw(waved(model));
  const std::uint64_t columns = model.grid.nx / 2,
                      rows = model.grid.ny / 2;  // n − 1 cells, halved and rounded up
  EXPECT_EQ(coarse.counts().cloth_triangles, 2 * columns * rows);
  EXPECT_NE(every.rgba, second.rgba);
}

/// A small horizontal cloth over a floor, out of the way of what a test looks at.
Scene floor_scene() {
  Scene scene;
  scene.cloth.orientation = Orientation::horizontal;
  scene.cloth.width_m = scene.cloth.height_m = 0.4;
  scene.cloth.resolution = 9;
  scene.cloth.center_m = {-1.0, 0.5, -0.5};
  scene.floor = FloorSection{};
  return scene;
}

// Two layers in one plane, as a floor presses them, look as if the first rows lay on top (the depths of
// cloth_in_clip in shaders/draw/view.glsl); by rounding alone pixels would take turns.
TEST_F(RendererTest, LayersInOnePlaneDoNotTakeTurns) {
  Scene scene = floor_scene();
  scene.cloth.resolution = 21;
  scene.cloth.center_m = {0.0, 0.5, 0.0};
  const Model model = build_model(scene);
  State folded = start_state(model);
  for (glm::dvec3& x : folded.position) x.z = -std::abs(x.z);
  State apart = folded;
  for (std::size_t k = model.grid.index(0, 11); k < apart.position.size(); ++k) apart.position[k].y -= 0.01;
  RenderOptions options = small_picture();
  options.camera = Camera{{0.0, 0.5, 0.0}, 0.5, 0.6, 1.2, 0.68};
  const Picture together = OffscreenRenderer(device(), model, options).draw(folded);
  const Picture wanted = OffscreenRenderer(device(), model, options).draw(apart);
  int other = 0;
  for (int a = 1; a < 40; ++a)
    for (int b = 3; b < 18; ++b) {
      const glm::dvec3 place{0.19 * (a - 20) / 20.0, 0.5, -0.01 * b};
      const Color c = color_at(together, *options.camera, place),
                  w = color_at(wanted, *options.camera, place);
      other += std::abs(c.red - w.red) + std::abs(c.green - w.green) > 60;
    }
  EXPECT_LT(other, 6) << "of 585 places";  // a few at the printed lines' edges
}

TEST_F(RendererTest, SphereDarkensTheFloorBehindItAsSeenFromTheLight) {
  Scene scene = floor_scene();
  RenderOptions options = small_picture();
  options.camera = Camera{{0.2, 0.2, 0.0}, 0.5, 0.6, 4.0, 0.68};
  const glm::dvec3 center{0.0, 0.6, 0.3};
  const Model model = build_model(scene);
  const glm::dvec3 light =
      make_view(model, {scene_bounds(model), 1024}, *options.camera, 1.5, 0.0, 0.05).to_light;
  const glm::dvec3 shaded = center - light * (center.y / light.y);
  const Picture without = draw(scene, options);
  scene.spheres = {SphereSection{center, 0.2, {0.0, 0.0, 0.0}, 0.0}};
  const Picture with = draw(scene, options);
  EXPECT_LT(color_at(with, *options.camera, shaded).sum(),
            0.75 * color_at(without, *options.camera, shaded).sum());
  // As far again on the other side nothing changes but a little occlusion.
  const glm::dvec3 open = shaded + 1.6 * glm::dvec3(light.x, 0.0, light.z) * (center.y / light.y);
  EXPECT_GT(color_at(with, *options.camera, open).sum(),
            0.9 * color_at(without, *options.camera, open).sum());
}

TEST_F(RendererTest, MovingSphereIsDrawnWhereItIs) {
  Scene scene = floor_scene();
  scene.spheres = {SphereSection{{0.0, 0.4, 0.0}, 0.15, {0.5, 0.0, 0.0}, 0.0}};
  RenderOptions options = small_picture();
  options.camera = Camera{{0.3, 0.3, 0.0}, 0.0, 0.3, 4.0, 0.68};
  const Model model = build_model(scene);
  State state = start_state(model);
  OffscreenRenderer renderer(device(), model, options);
  const Picture first = renderer.draw(state);
  state.time_s = 1.2;
  const Picture later = renderer.draw(state);
  const auto blue = [&](const Picture& picture, double x) {
    const Color c = color_at(picture, *options.camera, {x, 0.4, 0.0});
    return c.blue - c.red;
  };
  EXPECT_GT(blue(first, 0.0), 40);  // the sphere's blue clay, nothing else is so blue
  EXPECT_GT(blue(later, 0.6), 40);
  EXPECT_LT(blue(later, 0.0), 20);
}

TEST_F(RendererTest, HeatIsRedWhereStretchedAndBlueWhereCompressed) {
  Scene scene;
  scene.cloth.resolution = 17;
  const Model model = build_model(scene);
  RenderOptions options = small_picture();
  options.look.heat = true;
  options.look.heat_full = 0.05;
  OffscreenRenderer renderer(device(), model, options);
  const auto warmth = [&](double factor) {
    State state = start_state(model);
    for (glm::dvec3& p : state.position) p.x *= factor;
    const Color c = color_at(renderer.draw(state), renderer.camera(), {0.02, 0.02, 0.0});
    return c.red - c.blue;
  };
  EXPECT_LT(std::abs(warmth(1.0)), 45);  // nearly white under a slightly warm light
  EXPECT_GT(warmth(1.04), warmth(1.0) + 60);
  EXPECT_LT(warmth(0.96), warmth(1.0) - 60);
}

TEST_F(RendererTest, FrontAndBackHaveDifferentTints) {
  Scene scene;
  scene.cloth.resolution = 17;
  const Model model = build_model(scene);
  RenderOptions options = small_picture();
  const glm::dvec3 spot{0.03, 0.03, 0.0};
  const auto greenness = [&](double yaw_rad) {
    options.camera = Camera{{0.0, 0.0, 0.0}, yaw_rad, 0.1, 2.0, 0.68};
    const Color c =
        color_at(OffscreenRenderer(device(), model, options).draw(start_state(model)), *options.camera, spot);
    return double(c.green) / c.red;
  };
  EXPECT_LT(greenness(0.3), 0.6);         // red in front
  EXPECT_GT(greenness(0.3 + 3.14), 0.6);  // sand behind
}

// f64 draws from buffers of its own, in float; after a frame and after a write alike.
TEST_F(RendererTest, DeviceBuffersAndHostStateGiveTheSamePicture) {
  Scene scene = sheet_scene();
  scene.cloth.imperfection_m = 0.01;
  for (const char* precision : {"f32", "f64"}) {
    scene.solver.precision = precision;
    if (scene.solver.precision == "f64" && !device().info().float64) continue;
    const Model model = build_model(scene);
    const auto simulation = GpuSimulation::create(device(), model, find_solver("leapfrog"));
    OffscreenRenderer renderer(device(), model, small_picture());
    const auto expect_same_picture = [&] {
      const Picture direct = renderer.draw(simulation->draw_buffers(), simulation->time_s());
      // Normals differ in the last bits only: less than one step of colour on average.
      EXPECT_LT(difference(direct, renderer.draw(simulation->read())).mean, 0.05) << precision;
    };
    for (int frame = 0; frame < 6; ++frame) simulation->advance(1.0 / 60.0, simulation->plan().substeps);
    expect_same_picture();
    simulation->write(waved(model));
    expect_same_picture();
  }
}

TEST_F(RendererTest, SamePictureTwiceToTheBit) {
  EXPECT_EQ(draw(sheet_scene(), small_picture()).rgba, draw(sheet_scene(), small_picture()).rgba);
}

TEST_F(RendererTest, FourSamplesOnlySmoothEdges) {
  RenderOptions options = small_picture();
  const Picture one = draw(sheet_scene(), options);
  options.samples = 4;
  const Picture four = draw(sheet_scene(), options);
  EXPECT_NE(one.rgba, four.rgba);
  EXPECT_LT(difference(one, four).mean, 3.0);
}

TEST_F(RendererTest, WorksThroughTheStagingPath) {
  const Picture plain = draw(sheet_scene(), small_picture());
  const auto staged = make_device(true);
  const Model model = build_model(sheet_scene());
  {
    OffscreenRenderer renderer(*staged, model, small_picture());
    EXPECT_EQ(renderer.draw(waved(model)).rgba, plain.rgba);
  }
  expect_silence(*staged);
}

TEST_F(RendererTest, RefusesImpossibleSizesAndSamples) {
  const Model model = build_model(sheet_scene());
  const auto code = [&](const RenderOptions& options) {
    try {
      OffscreenRenderer renderer(device(), model, options);
    } catch (const Error& refused) {
      return refused.code();
    }
    return Exit::ok;
  };
  RenderOptions options = small_picture();
  options.width = 0;
  EXPECT_EQ(code(options), Exit::usage);
  options.width = 1u << 30;
  EXPECT_EQ(code(options), Exit::usage);
  options = small_picture();
  options.samples = 3;
  EXPECT_EQ(code(options), Exit::usage);
}

TEST_F(RendererTest, SmallestClothAndManyBalls) {
  Scene scene = sheet_scene();
  scene.cloth.resolution = 2;
  scene.pins.clear();
  scene.spheres.clear();
  for (int k = 0; k < 64; ++k)
    scene.spheres.push_back(SphereSection{{0.1 * (k % 8), 0.05, 0.1 * (k / 8)}, 0.04, {0, 0, 0}, 0.0});
  const Model model = build_model(scene);
  EXPECT_EQ(ball_count(model), 64u);
  OffscreenRenderer renderer(device(), model, small_picture());
  EXPECT_EQ(renderer.draw(start_state(model)).rgba.size(), std::size_t{4} * 240 * 136);
}

}  // namespace
}  // namespace weft::test
