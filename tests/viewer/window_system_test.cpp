// What a window system does to a window: full screen, minimising, sizes that change faster than pictures are
// drawn, a surface that is lost.
#include "viewer/window_fixture.h"

namespace weft {
namespace {

using test::WindowTest;
using test::WindowUnderTest;

TEST_F(WindowTest, FullScreenAndBack) {
  WindowUnderTest window({"1", "--resolution", "16"});
  ASSERT_EQ(window.value("size"), "1280x720");
  window.key("F11");
  EXPECT_TRUE(window.wait_for("size", "1600x1000")) << "the display's size, at " << window.value("size");
  EXPECT_TRUE(window.wait_pictures(3));
  window.key("F11");
  EXPECT_TRUE(window.wait_for("size", "1280x720"));
  EXPECT_TRUE(window.wait_pictures(3));
  expect_silence(window);
}

TEST_F(WindowTest, AMinimisedWindowComputesNothing) {
  WindowUnderTest window({"1", "--resolution", "16"});
  window.wait_pictures(5);
  if (!window.say_minimised(true)) GTEST_SKIP() << "libX11 cannot be loaded";
  ASSERT_TRUE(window.wait_for("minimised", "1"));
  const double time_s = window.number("time_s"), pictures = window.number("pictures");
  window.act("sleep 1");
  EXPECT_EQ(window.number("time_s"), time_s);
  EXPECT_EQ(window.number("pictures"), pictures);
  window.say_minimised(false);
  ASSERT_TRUE(window.wait_for("minimised", "0"));
  EXPECT_TRUE(window.wait_pictures(3));
  EXPECT_LT(window.number("time_s"), time_s + 1.0) << "the time away is not caught up";
  expect_silence(window);
}

TEST_F(WindowTest, SizesThatChangeFasterThanPictures) {
  WindowUnderTest window({"1", "--resolution", "16"});
  std::string storm;
  for (int k = 0; k < 40; ++k)
    storm += "windowsize $W " + std::to_string(330 + 37 * (k % 17)) + " " +
             std::to_string(250 + 23 * (k % 13)) + " sleep 0.01 ";
  window.act(storm + "windowsize --sync $W 1 1 sleep 0.3 windowsize --sync $W 801 603");
  EXPECT_TRUE(window.wait_for("size", "801x603"));
  EXPECT_TRUE(window.wait_pictures(3));
  expect_silence(window);
}

TEST_F(WindowTest, ALostSurfaceIsReplaced) {
  test::ScopedEnvironment loss("WEFT_SIMULATE_SURFACE_LOSS_AFTER", "8");
  WindowUnderTest window({"1", "--resolution", "16"});
  EXPECT_TRUE(window.wait_pictures(20)) << "pictures go on after the eighth";
  expect_silence(window);
}

}  // namespace
}  // namespace weft
