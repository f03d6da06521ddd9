// The panel's diagram and sliders without a window: where things lie, and that the sliders choose what
// --error and --budget choose.
#include "viewer/setting_choice.h"

#include <gtest/gtest.h>

#include <cmath>

#include "viewer/diagram_layout.h"
#include "viewer/studied_cloth.h"
#include "viewer/window_driver.h"

namespace weft {
namespace {

constexpr PlotBox kBox{100.0f, 50.0f, 500.0f, 350.0f};

study::Study studied() { return test::hand_made_study(Scene{}, "a device"); }

TEST(DiagramLayout, DecadesAreEquallyLong) {
  const DiagramLayout layout(studied(), 17, kBox, {});
  EXPECT_NEAR(layout.x_at(1000.0) - layout.x_at(100.0), layout.x_at(100.0) - layout.x_at(10.0), 1e-3);
  EXPECT_NEAR(layout.y_at(1e-4) - layout.y_at(1e-3), layout.y_at(1e-5) - layout.y_at(1e-4), 1e-3);
  EXPECT_GT(layout.x_at(200.0), layout.x_at(100.0)) << "dearer lies to the right";
  EXPECT_LT(layout.y_at(1e-3), layout.y_at(1e-4)) << "less accurate lies above";
}

TEST(DiagramLayout, MarksLieAtTheirNumbersAndDivergedOnesInTheMargin) {
  const DiagramLayout layout(studied(), 17, kBox, {});
  std::size_t marks = 0;
  for (const PlotLine& line : layout.lines())
    for (const PlotMark& mark : line.marks) {
      ++marks;
      EXPECT_FLOAT_EQ(mark.place.x, layout.x_at(mark.point.ms_per_s));
      if (mark.point.diverged) {
        EXPECT_GT(mark.place.y, kBox.top);
        EXPECT_LT(mark.place.y, kBox.top + DiagramLayout::kMargin);
      } else {
        EXPECT_FLOAT_EQ(mark.place.y, layout.y_at(mark.point.error_m));
        EXPECT_GT(mark.place.y, kBox.top + DiagramLayout::kMargin);
        EXPECT_LT(mark.place.y, kBox.bottom);
      }
      EXPECT_EQ(layout.nearest({mark.place.x + 2.0f, mark.place.y - 1.0f}, 10.0f)->point.setting,
                mark.point.setting);
    }
  EXPECT_EQ(marks, 5u);
  EXPECT_EQ(layout.lines().size(), 3u) << "a line a solver";
  EXPECT_EQ(layout.front().size(), 4u) << "each dearer point is more accurate";
  EXPECT_EQ(layout.nearest({kBox.left, kBox.bottom}, 10.0f), nullptr);
}

TEST(DiagramLayout, TheAxisReachesWhatRunsNow) {
  for (const double ms_per_s : {3.0, 250.0, 90000.0}) {
    const DiagramLayout layout(studied(), 17, kBox, ms_per_s);
    EXPECT_GT(layout.x_at(ms_per_s), kBox.left);
    EXPECT_LT(layout.x_at(ms_per_s), kBox.right);
  }
  EXPECT_TRUE(DiagramLayout(studied(), 17, kBox, {}).shows_real_time()) << "800 ms per second is near it";
}

TEST(SettingChoice, SaysWhatWasChosenOrByHowMuchNothingFits) {
  const study::Study study = studied();  // frames of 1/60 s
  const SettingChoice chosen = choose_setting(study, 17, {.kind = WishKind::error, .error_m = 5e-4});
  ASSERT_TRUE(chosen.point);
  EXPECT_EQ(chosen.point->setting, (study::Setting{"leapfrog", "f32", 80}));
  EXPECT_NE(chosen.line.find("2.50e-04 m, 3.33 ms a frame"), std::string::npos) << chosen.line;
  const SettingChoice none = choose_setting(study, 17, {.kind = WishKind::error, .error_m = 4e-7});
  EXPECT_FALSE(none.point);
  EXPECT_NE(none.line.find("misses it by 6e-07 m: rk4"), std::string::npos) << none.line;
  const SettingChoice dear = choose_setting(study, 17, {.kind = WishKind::budget, .budget_ms = 1.0});
  EXPECT_FALSE(dear.point);  // the cheapest takes 100/60 ms
  EXPECT_NE(dear.line.find("misses it by 0.667 ms: leapfrog"), std::string::npos) << dear.line;
  EXPECT_FALSE(choose_setting(study, 17, {.kind = WishKind::by_hand}).point);
}

/// "leapfrog f32 at 80" in what the command says it chose; empty when it refused.
std::string chosen_by_command(const std::string& scene, const std::string& wish) {
  std::string output;
  test::run_command(WEFT_PROGRAM " simulate " + scene + " --time 0.5 --device cpu " + wish, output);
  const std::size_t at = output.find("chosen: "), end = output.find(" substeps", at);
  return at == std::string::npos ? "" : output.substr(at + 8, end - at - 8);
}

TEST(SettingChoice, IsWhatTheCommandsChoose) {
  const test::ScratchCache cache;
  const std::string file = test::small_scene_file(cache.folder());
  const Scene scene = load_scene(file, {}).scene;
  const study::Study study = test::hand_made_study(scene, "CPU reference");
  study::keep_study(scene, study);
  ASSERT_TRUE(study::kept_study(scene, "CPU reference", 0.5));
  const auto compare = [&](const SettingWish& wish, const std::string& option) {
    const SettingChoice choice = choose_setting(study, 17, wish);
    const std::string ours = choice.point
                                 ? choice.point->setting.solver + " " + choice.point->setting.precision +
                                       " at " + std::to_string(choice.point->setting.substeps)
                                 : "";
    EXPECT_EQ(chosen_by_command(file, option), ours) << option;
  };
  for (const char* error : {"2e-3", "1e-3", "3e-4", "1e-5", "5e-7"})
    compare({.kind = WishKind::error, .error_m = std::stod(error)}, std::string("--error ") + error);
  for (const char* budget : {"1", "2", "4", "20"})
    compare({.kind = WishKind::budget, .budget_ms = std::stod(budget)}, std::string("--budget ") + budget);
}

}  // namespace
}  // namespace weft
