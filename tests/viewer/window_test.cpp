// The window as a person uses it: real keys and a real mouse on a virtual display, under core and
// synchronization validation. Skipped with a word where there is no Xvfb, xdotool or Vulkan device.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "render/image.h"
#include "support/full_run.h"
#include "viewer/window_fixture.h"

namespace weft {
namespace {

using test::WindowTest;
using test::WindowUnderTest;

TEST_F(WindowTest, KeysOpenScenesPauseStepAndShowHelp) {
  WindowUnderTest window({"1", "--resolution", "20"});
  for (const char* number : {"3", "6", "2"}) {
    window.key(number);
    EXPECT_TRUE(window.wait_for("scene", number));
  }
  window.key("space");
  EXPECT_TRUE(window.wait_for("paused", "1"));
  window.wait_pictures(2);
  const double time_s = window.number("time_s");
  window.wait_pictures(3);
  EXPECT_EQ(window.number("time_s"), time_s) << "nothing moves while paused";
  window.key("period");
  window.key("Right");
  std::ostringstream later;
  later << std::fixed;
  later.precision(6);
  later << (std::floor(time_s * 60.0 + 1e-3) + 2.0) / 60.0;  // a pause within a frame: the first step ends it
  EXPECT_TRUE(window.wait_for("time_s", later.str()))
      << "two single steps of 1/60 s from " << time_s << ", at " << window.value("time_s");
  window.key("r");
  EXPECT_TRUE(window.wait_for("time_s", "0.000000"));
  window.key("space");
  EXPECT_TRUE(window.wait_for("paused", "0"));
  struct Toggle {
    const char *key, *name, *on, *off;
  };
  for (const Toggle& t : {Toggle{"F1", "help", "1", "0"},
                          {"F2", "overlay", "0", "1"},
                          {"F3", "timings", "1", "0"},
                          {"m", "wireframe", "1", "0"},
                          {"n", "smooth", "0", "1"},
                          {"h", "heat", "1", "0"},
                          {"Tab", "panels", "0", "1"}}) {
    window.key(t.key);
    EXPECT_TRUE(window.wait_for(t.name, t.on)) << t.key;
    window.wait_pictures(2);
    window.key(t.key);
    EXPECT_TRUE(window.wait_for(t.name, t.off)) << t.key;
  }
  window.key("minus");
  EXPECT_TRUE(window.wait_for("speed", "0.800"));
  window.key("equal");
  EXPECT_TRUE(window.wait_for("speed", "1.000"));
  expect_silence(window);
  window.key("Escape");
  EXPECT_TRUE(window.wait_for("quit_question", "1"));
  window.key("Escape");
  EXPECT_TRUE(window.wait_for("quit_question", "0"));
  window.key("Escape");
  window.key("Return");
  EXPECT_EQ(window.exit_code(), 0);
}

TEST_F(WindowTest, MouseOrbitsZoomsPansPullsAndPins) {
  WindowUnderTest window({"1", "--resolution", "20"});
  window.key("space");
  ASSERT_TRUE(window.wait_for("paused", "1"));
  const std::string camera = window.value("camera");
  /// What the hands do moves the camera; Home brings it back.
  const auto moves = [&](const char* hands) {
    window.act(hands);
    for (int k = 0; k < 100 && window.value("camera") == camera; ++k) window.wait_pictures(1, 1.0);
    EXPECT_NE(window.value("camera"), camera) << hands;
    window.key("Home");
    EXPECT_TRUE(window.wait_for("camera", camera)) << hands;
  };
  moves(
      "mousemove --window $W 1200 690 mousedown 1 mousemove --window $W --sync 1230 670 mouseup 1");  // orbit
  moves("mousemove --window $W 1200 690 mousedown 2 mousemove_relative --sync 40 10 mouseup 2");      // pan
  moves("mousemove --window $W 1200 690 click 4");                                                    // zoom
  moves("keydown w sleep 0.3 keyup w");

  window.key("space");
  window.act("mousemove --window $W 800 330 mousedown 1 mousemove_relative --sync 12 8");
  EXPECT_TRUE(window.wait_for("hand", "1")) << "the cloth is held";
  window.act("mousemove_relative --sync 60 20");
  window.wait_pictures(3);
  window.act("mouseup 1");
  EXPECT_TRUE(window.wait_for("hand", "0"));
  EXPECT_LT(window.number("stretch"), 1.0) << "a pull stretches, it does not explode";
  window.key("p");
  EXPECT_TRUE(window.wait_for("hand_pins", "1") || window.wait_for("pins", "1"))
      << "pinned under the pointer";
  expect_silence(window);
}

TEST_F(WindowTest, ResizeScreenshotAndVideo) {
  WindowUnderTest window({"5", "--resolution", "20"});
  for (const auto& [width, height] : {std::pair{700, 500}, {1180, 760}, {402, 301}}) {
    window.act("windowsize --sync $W " + std::to_string(width) + " " + std::to_string(height));
    EXPECT_TRUE(window.wait_for("size", std::to_string(width) + "x" + std::to_string(height)));
    window.wait_pictures(3);
  }
  window.key("F12");
  for (int k = 0; k < 200 && window.events("screenshot").empty(); ++k) window.wait_pictures(1);
  const Picture picture = read_png(window.folder() / "weft-0001.png");
  EXPECT_EQ(picture.width, 402u);
  EXPECT_EQ(picture.height, 301u);
  window.key("v");
  EXPECT_TRUE(window.wait_for("filming", "1"));
  window.wait_pictures(5);
  window.key("v");
  EXPECT_TRUE(window.wait_for("filming", "0"));
  EXPECT_TRUE(std::filesystem::exists(window.folder() / "weft-0001.mp4"));
  window.act("windowunmap --sync $W");  // as a minimised window: nothing to draw on, nothing to compute for
  window.act("windowmap --sync $W");
  EXPECT_TRUE(window.wait_pictures(2));
  expect_silence(window);
}

// The other tests of the window run the shaders, for --validation speaks of Vulkan. This one: what a person
// does with a cloth that native computes on a thread of its own, in one window.
TEST_F(WindowTest, NativeComputesWhatAPersonPullsAndChanges) {
  WindowUnderTest window({"1", "--resolution", "64", "--device", "native"});
  EXPECT_EQ(window.value("native"), "1");
  window.key("space");
  ASSERT_TRUE(window.wait_for("paused", "1"));  // before the wind takes the cloth from under the pointer
  window.act("mousemove --window $W 800 330");
  window.wait_pictures(2);
  window.key("p");
  EXPECT_TRUE(window.wait_for("hand_pins", "1")) << "pinned under the pointer";
  window.key("space");
  EXPECT_TRUE(window.wait_for("paused", "0"));
  window.wait_pictures(10);
  EXPECT_GT(window.number("time_s"), 0.0);
  EXPECT_GT(window.number("frame_ms"), 0.0);
  // Well away from the pin: the few cells between a pin and a hand beside it stretch by several times.
  window.act("mousemove --window $W 800 500 mousedown 1 mousemove_relative --sync 12 8");
  EXPECT_TRUE(window.wait_for("hand", "1")) << "the cloth is held";
  window.act("mousemove_relative --sync 60 20");
  window.wait_pictures(3);
  window.act("mouseup 1");
  EXPECT_TRUE(window.wait_for("hand", "0"));
  EXPECT_LT(window.number("stretch"), 1.0) << "a pull stretches, it does not explode";
  drag_slider(window, 0.0);
  EXPECT_TRUE(window.wait_for("resolution", "16"));
  const double time_s = window.number("time_s");
  window.wait_pictures(5);
  EXPECT_GT(window.number("time_s"), time_s) << "the run goes on";
  window.key("5");
  EXPECT_TRUE(window.wait_for("scene", "5"));
  window.key("space");
  EXPECT_TRUE(window.wait_for("paused", "1"));
  window.wait_pictures(2);
  const double paused_s = window.number("time_s");
  window.wait_pictures(3);
  EXPECT_EQ(window.number("time_s"), paused_s);
  window.key("r");
  EXPECT_TRUE(window.wait_for("time_s", "0.000000"));
  EXPECT_EQ(window.value("native"), "1");
  expect_silence(window);
}

// A drag in the scene and a click on the slider 30 ms after it, however long pictures take: both are seen.
TEST_F(WindowTest, NoClickIsLostBetweenTwoPictures) {
  WindowUnderTest window({"1", "--resolution", "64", "--device", "native"});
  window.wait_pictures(10);  // the panel has its lines, and the slider its place
  for (int k = 0; k < 4; ++k) {
    const double rebuilds = window.number("rebuilds");
    window.act("mousemove --window $W 1200 690 mousedown 1 sleep 0.03 mouseup 1 mousemove --window $W " +
               slider_place(window, "slider", k % 2 == 0 ? 0.0 : 0.3) +
               " sleep 0.03 mousedown 1 sleep 0.03 mouseup 1");
    for (int wait = 0; wait < 100 && window.number("rebuilds") == rebuilds; ++wait)
      window.wait_pictures(1, 0.2);
    EXPECT_GT(window.number("rebuilds"), rebuilds) << "click " << k;
  }
  expect_silence(window);
}

TEST_F(WindowTest, TheResolutionSliderCarriesTheClothOver) {
  WindowUnderTest window({"1", "--resolution", "24"});
  window.wait_pictures(10);
  drag_slider(window, 0.0);
  EXPECT_TRUE(window.wait_for("resolution", "16"));
  drag_slider(window, 0.3);
  for (int k = 0; k < 50 && window.number("resolution") < 40; ++k) window.wait_pictures(1);
  EXPECT_NEAR(window.number("resolution"), 16.0 * std::pow(64.0, 0.3), 8.0) << "the slider is logarithmic";
  EXPECT_GT(window.number("time_s"), 0.0) << "the run goes on";
  EXPECT_LT(window.number("stretch"), 0.5);
  expect_silence(window);
}

// A hundred rounds in the full run.
TEST_F(WindowTest, ManyScenesAndResolutionsLeaveNothingBehind) {
  const int rounds = test::full_run() ? 100 : 20;
  WindowUnderTest window({"1", "--resolution", "20"});
  const auto settle = [&](const char* scene) {
    window.key(scene);
    EXPECT_TRUE(window.wait_for("scene", scene));
    window.wait_pictures(3);
    return window.number(
        "live");  // bytes follow the picture's size, which adapts; running_scene_test has them
  };
  const auto once = [&](int k) {
    const double rebuilds = window.number("rebuilds");
    window.key(std::to_string(1 + k % 6));
    drag_slider(window, 0.02 * (k % 8));
    for (int wait = 0; wait < 100 && window.number("rebuilds") < rebuilds + 2; ++wait)
      window.wait_pictures(1, 1.0);
  };
  for (int k = 0; k < 8; ++k) once(k);  // every pipeline and block has been made once
  const double before = settle("1");
  const double rebuilds = window.number("rebuilds");
  for (int k = 0; k < rounds; ++k) once(k);
  EXPECT_GE(window.number("rebuilds"), rebuilds + 2 * rounds) << "a scene and a resolution in each round";
  EXPECT_EQ(settle("1"), before) << "live allocations";
  expect_silence(window);
}

TEST_F(WindowTest, RefusesASoftwareDeviceWhenAGpuIsRequired) {
  std::string output;
  bool all_software = true;
  for (const gpu::DeviceInfo& info : gpu::list_devices())
    all_software &= info.software || !info.unusable.empty();
  if (!all_software) GTEST_SKIP() << "there is a GPU here";
  EXPECT_EQ(test::run_command("WEFT_REQUIRE_GPU=1 " WEFT_PROGRAM " view 1", output), 3);
  EXPECT_NE(output.find("software device"), std::string::npos) << output;
  EXPECT_EQ(test::run_command(WEFT_PROGRAM " view 1 --device no-such-device", output), 3) << output;
  EXPECT_EQ(test::run_command(WEFT_PROGRAM " view no-such-scene", output), 2) << output;
}

TEST(Display, WithoutOneTheMessageSaysWhatToDo) {
  std::string output;
  EXPECT_EQ(test::run_command("env -u DISPLAY -u WAYLAND_DISPLAY " WEFT_PROGRAM " view 1", output), 3);
  EXPECT_NE(output.find("weft render"), std::string::npos) << output;
  EXPECT_NE(output.find("no display"), std::string::npos) << output;
}

}  // namespace
}  // namespace weft
