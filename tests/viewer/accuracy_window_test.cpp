// The accuracy panel in a real window: its key shows it, its slider chooses, closed it is gone.
#include <filesystem>

#include "render/image.h"
#include "viewer/setting_choice.h"
#include "viewer/studied_cloth.h"
#include "viewer/window_fixture.h"

namespace weft {
namespace {

using test::WindowTest;
using test::WindowUnderTest;

/// The share of light pixels (the diagram's paper) in the right 400 columns of the window.
double paper_share(const WindowUnderTest& window, int picture) {
  const std::string name = "weft-000" + std::to_string(picture) + ".png";
  window.key("F12");
  for (int k = 0; k < 200 && window.events("screenshot").size() < static_cast<std::size_t>(picture); ++k)
    window.wait_pictures(1);
  const Picture shot = read_png(window.folder() / name);
  std::size_t light = 0, all = 0;
  for (std::uint32_t y = 20; y < shot.height / 2; ++y)
    for (std::uint32_t x = shot.width - 400; x < shot.width - 20; ++x, ++all) {
      const std::uint8_t* p = &shot.rgba[4 * (std::size_t{y} * shot.width + x)];
      light += p[0] == 250 && p[1] == 250 && p[2] == 247;
    }
  return static_cast<double>(light) / static_cast<double>(all);
}

std::string best_device() {
  for (const gpu::DeviceInfo& info : gpu::list_devices())
    if (info.unusable.empty()) return info.label();
  return "";
}

TEST_F(WindowTest, TheAccuracyPanelShowsChoosesAndCloses) {
  const test::ScratchCache cache;
  const std::string file = test::small_scene_file(cache.folder());
  const Scene scene = load_scene(file, {}).scene;
  const study::Study study = test::hand_made_study(scene, best_device());
  study::keep_study(scene, study);
  WindowUnderTest window({file});
  window.wait_pictures(5);
  EXPECT_LT(paper_share(window, 1), 0.05);
  const double live = window.number("live");
  window.key("F4");
  ASSERT_TRUE(window.wait_for("accuracy", "1"));
  EXPECT_TRUE(window.wait_for("study", "kept"));
  window.wait_pictures(3);
  EXPECT_GT(paper_share(window, 2), 0.3) << "the diagram";
  test::WindowTest::drag_slider(window, 0.6, "error_slider");
  for (int k = 0; k < 100 && window.number("wish_error") == 1e-3; ++k) window.wait_pictures(1);
  const double error_m = window.number("wish_error");
  EXPECT_NEAR(std::log10(error_m), -8.0 + 0.6 * 7.0, 0.2) << "decades along the slider";
  const SettingChoice choice = choose_setting(study, 17, {.kind = WishKind::error, .error_m = error_m});
  ASSERT_TRUE(choice.point);
  EXPECT_TRUE(window.wait_for("solver", choice.point->setting.solver));
  EXPECT_TRUE(window.wait_for("substeps", std::to_string(choice.point->setting.substeps)));
  for (int k = 0; k < 400 && window.number("live_error") < 0.0; ++k) window.wait_pictures(1);
  EXPECT_GT(window.number("live_error"), 0.0);
  EXPECT_GT(window.number("live"), live) << "open it has a copy of the cloth";
  window.key("F4");
  ASSERT_TRUE(window.wait_for("accuracy", "0"));
  window.wait_pictures(3);
  EXPECT_LT(paper_share(window, 3), 0.05);
  expect_silence(window);
}

TEST_F(WindowTest, AStudyRunsBesideTheWindowAndCanBeCancelled) {
  const test::ScratchCache cache;
  WindowUnderTest window({test::small_scene_file(cache.folder())});
  window.key("F4");
  ASSERT_TRUE(window.wait_for("study", "none"));
  window.wait_pictures(2);
  drag_slider(window, 0.5, "study_button");
  ASSERT_TRUE(window.wait_for("study", "running"));
  EXPECT_TRUE(window.wait_for("paused", "1")) << "the cloth rests meanwhile";
  EXPECT_TRUE(window.wait_pictures(10)) << "the window does not";
  drag_slider(window, 0.5, "study_button");
  EXPECT_TRUE(window.wait_for("study", "none", 60.0));
  EXPECT_TRUE(window.wait_for("paused", "0"));
  EXPECT_EQ(window.value("error"), "0");
  expect_silence(window);
}

}  // namespace
}  // namespace weft
