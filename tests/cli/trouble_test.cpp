// A device that is lost or has no memory, simulated by debug switches, and a cloth too large for it: a clear
// message, exit 3, and files as they were.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/process.h"

namespace weft::test {
namespace {

/// Runs scene 1 with an --out that exists already, and expects exit 3 with everything as it was.
std::string fails_and_leaves_files(const Environment& trouble, const Arguments& more = {}) {
  const Scratch scratch;
  write_text(scratch.path("state.csv"), "precious\n");
  Arguments all{"simulate", "1", "--device", "0", "--time", "1", "--out", scratch.path("state.csv")};
  all.insert(all.end(), more.begin(), more.end());
  const Result result = weft(all, trouble);
  EXPECT_CODE(result, 3);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(read_text(scratch.path("state.csv")), "precious\n");
  EXPECT_EQ(scratch.file_count(), 1u);
  EXPECT_EQ(lines_of(result.err).size(), 1u) << result.err;
  return result.err;
}

// The 20th submission is in the middle of the run: a second of scene 1 is 60 frames of at least one each.
TEST(Trouble, ALostDeviceIsExitThreeAndLeavesFiles) {
  NEEDS_VULKAN();
  for (const char* after : {"0", "3", "20"}) {
    const std::string message = fails_and_leaves_files({{"WEFT_SIMULATE_DEVICE_LOSS_AFTER", after}});
    EXPECT_SAYS(message, "the device was lost");
    EXPECT_SAYS(message, "--device");
  }
}

TEST(Trouble, ALostDeviceWhileFilmingLeavesNoHalfPicture) {
  NEEDS_VULKAN();
  const Scratch scratch;
  const Result result =
      weft({"render", "1", "--device", "0", "--time", "1", "--size", "64x48", "--out", scratch.path("a.png")},
           {{"WEFT_SIMULATE_DEVICE_LOSS_AFTER", "30"}});
  EXPECT_CODE(result, 3);
  EXPECT_EQ(scratch.file_count(), 0u);
}

TEST(Trouble, MemoryUsedUpIsExitThreeAndLeavesFiles) {
  NEEDS_VULKAN();
  for (const char* bytes : {"0", "100000"}) {
    const std::string message = fails_and_leaves_files({{"WEFT_FAIL_ALLOCATION_AFTER_BYTES", bytes}});
    EXPECT_SAYS(message, "bytes");
  }
}

// 4096 x 4096 particles take 256 MiB a buffer: more than llvmpipe binds at once.
TEST(Trouble, AClothTooLargeIsRefusedWithTheBytesAndTheLargestThatFits) {
  NEEDS_VULKAN();
  const auto device = nlohmann::json::parse(weft({"devices", "--format", "json"}).out)[0];
  if (!device["software"].get<bool>()) GTEST_SKIP() << "the device may hold the largest cloth there is";
  const std::string message = fails_and_leaves_files({}, {"--resolution", "4096", "--substeps", "10"});
  EXPECT_SAYS(message, "needs ");
  EXPECT_SAYS(message, " bytes");
  const std::string phrase = "the largest resolution that fits is ";
  const std::size_t at = message.find(phrase);
  ASSERT_NE(at, std::string::npos) << message;
  const int fits = std::stoi(message.substr(at + phrase.size()));
  EXPECT_GT(fits, 1000);
  EXPECT_LT(fits, 4096);
}

}  // namespace
}  // namespace weft::test
