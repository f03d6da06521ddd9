// The GPU device that tests share: core and synchronization validation are on, and every test fails on
// any message. Without a usable device a test is skipped, or fails when WEFT_REQUIRE_GPU=1.
#pragma once
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>

#include "core/error.h"
#include "gpu/device.h"

namespace weft::test {

/// Sets an environment variable while in scope.
class ScopedEnvironment {
 public:
  ScopedEnvironment(std::string name, const std::string& value) : name_(std::move(name)) {
    const char* old = std::getenv(name_.c_str());
    had_ = old != nullptr;
    if (had_) old_ = old;
    setenv(name_.c_str(), value.c_str(), 1);
  }
  ~ScopedEnvironment() {
    if (had_)
      setenv(name_.c_str(), old_.c_str(), 1);
    else
      unsetenv(name_.c_str());
  }
  ScopedEnvironment(const ScopedEnvironment&) = delete;
  ScopedEnvironment& operator=(const ScopedEnvironment&) = delete;

 private:
  std::string name_, old_;
  bool had_ = false;
};

/// True when some device can run Weft.
inline bool gpu_there() {
  for (const gpu::DeviceInfo& info : gpu::list_devices())
    if (info.unusable.empty()) return true;
  return false;
}

inline bool gpu_required() {
  const char* text = std::getenv("WEFT_REQUIRE_GPU");
  return text != nullptr && std::string(text) == "1";
}

/// `device()` is made once a suite, with validation; pipelines are cached below the build folder.
class GpuTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    setenv("XDG_CACHE_HOME", WEFT_BINARY_DIR "/test-cache", 1);
    if (gpu_there()) shared_ = make_device();
  }
  static void TearDownTestSuite() { shared_.reset(); }

  void SetUp() override {
    if (shared_ != nullptr) {
      shared_->clear_validation_messages();
      return;
    }
    if (gpu_required()) FAIL() << "WEFT_REQUIRE_GPU=1, and no Vulkan device can run Weft";
    GTEST_SKIP() << "no Vulkan device can run Weft";
  }
  void TearDown() override {
    if (shared_ != nullptr) expect_silence(*shared_);
  }

  static gpu::Device& device() { return *shared_; }

  /// A device of a test's own, with validation; call expect_silence on it at the end.
  static std::unique_ptr<gpu::Device> make_device(bool force_staging = false) {
    gpu::DeviceOptions options;
    options.validation = true;
    options.force_staging = force_staging;
    return std::make_unique<gpu::Device>(options);
  }

  static void expect_silence(const gpu::Device& checked) {
    for (const std::string& message : checked.validation_messages())
      ADD_FAILURE() << "validation message: " << message;
  }

 private:
  static inline std::unique_ptr<gpu::Device> shared_;
};

}  // namespace weft::test
