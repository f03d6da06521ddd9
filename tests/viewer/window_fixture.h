// One virtual display for every test of real windows; skipped with a word where there is no Xvfb, xdotool or
// Vulkan device.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <sstream>
#include <string>

#include "gpu_fixture.h"
#include "viewer/window_driver.h"

namespace weft::test {

class WindowTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!window_tests_impossible().empty() || !gpu_there()) return;
    setenv("XDG_CACHE_HOME", WEFT_BINARY_DIR "/test-cache", 1);
    display_ = std::make_unique<VirtualDisplay>();
    setenv("DISPLAY", display_->name().c_str(), 1);
    unsetenv("WAYLAND_DISPLAY");
  }
  static void TearDownTestSuite() { display_.reset(); }
  void SetUp() override {
    if (!display_) GTEST_SKIP() << "no window: " << window_tests_impossible() << " (or no Vulkan device)";
  }
  static void expect_silence(const WindowUnderTest& window) {
    EXPECT_EQ(window.value("messages"), "0") << window.output();
  }

  /// A place along a slider that the log names, 0 its left and 1 its right end, as xdotool takes it.
  static std::string slider_place(const WindowUnderTest& window, const std::string& slider, double share) {
    std::stringstream text(window.value(slider));
    double left = 0, top = 0, right = 0, bottom = 0;
    char comma = 0;
    text >> left >> comma >> top >> comma >> right >> comma >> bottom;
    const int x = static_cast<int>(std::lround(left + 8.0 + share * (right - left - 16.0)));
    return std::to_string(x) + " " + std::to_string(static_cast<int>((top + bottom) / 2.0));
  }
  static void drag_slider(const WindowUnderTest& window, double share, const std::string& slider = "slider") {
    window.act("mousemove --window $W " + slider_place(window, slider, share) +
               " sleep 0.05 mousedown 1 sleep 0.05 mouseup 1");
  }

 private:
  static inline std::unique_ptr<VirtualDisplay> display_;
};

}  // namespace weft::test
