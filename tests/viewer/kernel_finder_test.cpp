// The window's trial of the kernels: when it begins, that it ends, and that the cloth does not notice.
#include "viewer/kernel_finder.h"

#include <gtest/gtest.h>

#include "model/measures.h"
#include "studied_cloth.h"

namespace weft {
namespace {

class KernelFinderTest : public test::GpuTest {
 protected:
  static constexpr double kPicture_s = 0.3;

  /// Pictures until something is said or the trial is over, at most 30.
  static std::string looked_at(KernelFinder& finder, RunningScene& running) {
    std::string said;
    for (int picture = 0; picture < 30 && said.empty(); ++picture) {
      said = finder.follow(running, kPicture_s);
      if (picture > 6 && finder.trying().empty()) break;
    }
    return said;
  }
};

// Three or four pictures are the second of calm; a candidate a picture follows; then the cloth, with the bits
// it had, runs on what was found, and so does the next one of the kind, without another trial.
TEST_F(KernelFinderTest, FindsTheKernelOnceWhileTheClothGoesOn) {
  test::ScratchCache cache;
  const std::unique_ptr<gpu::Device> own = make_device();
  RunningScene running(*own, {{"cloth.resolution=17"}}, "2");
  running.set_paused(true);
  running.step();
  do running.advance(0.0, 0.05);
  while (running.mid_frame());
  const State before = running.simulation().read();
  ASSERT_EQ(running.on_gpu()->kernel().how, "default");
  KernelFinder finder(*own, true);
  EXPECT_EQ(finder.follow(running, 10.0), "");
  for (int picture = 0; picture < 3; ++picture) finder.follow(running, kPicture_s);
  EXPECT_EQ(finder.trying(), "") << "less than a second of calm";
  finder.follow(running, kPicture_s);
  EXPECT_NE(finder.trying(), "");
  const std::string said = looked_at(finder, running);
  EXPECT_EQ(running.on_gpu()->kernel().how, "remembered");
  const std::string found = describe(running.on_gpu()->kernel().kernel);
  if (!said.empty()) {
    EXPECT_NE(said.find(found), std::string::npos) << said;
  }
  EXPECT_EQ(state_hash(running.simulation().read()), state_hash(before));

  RunningScene next(*own, {{"cloth.resolution=17"}}, "2");
  EXPECT_EQ(next.on_gpu()->kernel().how, "remembered");
  looked_at(finder, next);
  EXPECT_EQ(finder.trying(), "");
  expect_silence(*own);
}

// A slider that moves makes another cloth at every picture: none of them is tried.
TEST_F(KernelFinderTest, WaitsUntilASliderRests) {
  test::ScratchCache cache;
  const std::unique_ptr<gpu::Device> own = make_device();
  RunningScene running(*own, {{"cloth.resolution=17"}}, "2");
  KernelFinder finder(*own, true);
  for (std::uint32_t cells = 16; cells < 24; ++cells) {
    Scene next = running.scene();
    next.cloth.resolution = cells;
    running.apply(next);
    finder.follow(running, kPicture_s);
    finder.follow(running, kPicture_s);
    EXPECT_EQ(finder.trying(), "") << cells;
  }
}

// What nobody wants tried is not: with a kernel chosen by name, or on a device that compiles for seconds.
TEST_F(KernelFinderTest, LeavesAChosenKernelAndASoftwareDeviceAlone) {
  test::ScratchCache cache;
  const std::unique_ptr<gpu::Device> own = make_device();
  RunningScene chosen(*own, {{"cloth.resolution=17"}}, "2", "direct");
  KernelFinder finder(*own, true), none(*own, false);
  looked_at(finder, chosen);
  EXPECT_EQ(chosen.on_gpu()->kernel().how, "forced");
  RunningScene running(*own, {{"cloth.resolution=17"}}, "2");
  looked_at(none, running);
  EXPECT_EQ(running.on_gpu()->kernel().how, "default");
}

}  // namespace
}  // namespace weft
