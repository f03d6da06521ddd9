// Pictures against goldens in tests/golden/pictures. WEFT_UPDATE_GOLDENS=1 writes them anew: look at them.
//
// Tolerance: mean difference at most 2 of 255 and at most 2 % of the pixels more than 24 of 255 apart.
// Drivers may place an edge pixel differently (about 1 % of these small pictures are edges) and take more
// shadow samples; what goes wrong in a picture (a lost shadow, swapped sides, another camera) is above 3 and
// 5 %.
#include <cstdlib>
#include <filesystem>

#include "gpu_fixture.h"
#include "render/image.h"
#include "render/sheet.h"
#include "scene/reader.h"
#include "solvers/solver.h"

namespace weft::test {
namespace {

constexpr double kMeanTolerance = 2.0, kDifferingTolerance = 0.02;

bool within(const Difference& d) { return d.mean <= kMeanTolerance && d.differing <= kDifferingTolerance; }

void expect_golden(const std::string& name, const Picture& picture) {
  const std::filesystem::path folder = WEFT_SOURCE_DIR "/tests/golden/pictures";
  const std::filesystem::path golden = folder / (name + ".png");
  if (const char* update = std::getenv("WEFT_UPDATE_GOLDENS"); update != nullptr && update[0] == '1') {
    std::filesystem::create_directories(folder);
    write_png(golden, picture);
    return;
  }
  const Picture expected = read_png(golden);
  ASSERT_EQ(expected.width, picture.width);
  ASSERT_EQ(expected.height, picture.height);
  const Difference d = difference(expected, picture);
  const std::filesystem::path made = std::filesystem::path(WEFT_BINARY_DIR) / (name + ".made.png");
  if (!within(d)) write_png(made, picture);
  EXPECT_TRUE(within(d)) << name << ": mean difference " << d.mean << " of 255 (at most " << kMeanTolerance
                         << "), " << 100.0 * d.differing << " % of the pixels differ (at most "
                         << 100.0 * kDifferingTolerance << " %); compare " << made << " with " << golden
                         << ", and if the new picture is right set WEFT_UPDATE_GOLDENS=1";
}

class Goldens : public GpuTest {
 protected:
  static Picture sheet_picture(const Look& look) {
    const Model model = build_model(sheet_scene());
    RenderOptions options = small_picture();
    options.look = look;
    return OffscreenRenderer(device(), model, options).draw(waved(model));
  }
};

TEST_F(Goldens, SheetInEveryLook) {
  Look look;
  expect_golden("sheet-smooth", sheet_picture(look));
  look.shading = Shading::flat;
  expect_golden("sheet-flat", sheet_picture(look));
  look.heat = true;
  expect_golden("sheet-flat-heat", sheet_picture(look));
  look.shading = Shading::smooth;
  expect_golden("sheet-heat", sheet_picture(look));
  look.heat = false;
  look.wireframe = true;
  expect_golden("sheet-wireframe", sheet_picture(look));
}

TEST_F(Goldens, ToleranceTellsPicturesApart) {
  const Picture smooth = sheet_picture({});
  Look heat;
  heat.heat = true;
  EXPECT_FALSE(within(difference(smooth, sheet_picture(heat))));
  const Model model = build_model(sheet_scene());
  State mirrored = waved(model);
  for (glm::dvec3& p : mirrored.position) p.z = -p.z;
  OffscreenRenderer renderer(device(), model, small_picture());
  EXPECT_FALSE(within(difference(smooth, renderer.draw(mirrored)))) << "another shape must be seen";
}

TEST_F(Goldens, SixScenesAfterAQuarterSecond) {
  for (const AssetInfo& info : numbered_scenes()) {
    const Model model = build_model(load_scene(info.file).scene);
    const auto simulation = GpuSimulation::create(device(), model, find_solver(model.scene.solver.name));
    for (int frame = 0; frame < 15; ++frame)
      simulation->advance(model.scene.solver.frame_s, simulation->plan().substeps);
    OffscreenRenderer renderer(device(), model, small_picture());
    expect_golden(info.file.stem().string(), renderer.draw(simulation->draw_buffers(), simulation->time_s()));
  }
}

}  // namespace
}  // namespace weft::test
