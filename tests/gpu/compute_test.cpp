// Small compute shaders compiled at run time, dispatched, and held against what they must give.
#include <cstring>
#include <numeric>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/commands.h"
#include "gpu/pipeline.h"
#include "gpu/recorder.h"
#include "gpu/shader.h"
#include "gpu_fixture.h"

namespace weft {
namespace {

using namespace gpu;

constexpr std::uint32_t kCount = 1024;

constexpr const char* kScaleShader = R"(#version 460
layout(local_size_x_id = 1) in;
layout(constant_id = 0) const uint factor = 1u;
layout(push_constant) uniform Push { uint addend; uint count; };
layout(set = 0, binding = 3) restrict readonly buffer From { uint from[]; };
layout(set = 0, binding = 7) restrict writeonly buffer To { uint to[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < count) to[i] = from[i] * factor + addend;
}
)";

struct Push {
  std::uint32_t addend, count;
};

class Compute : public test::GpuTest {
 protected:
  static Buffer buffer(const char* name) {
    return Buffer(device(), name, kCount * 4, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::device);
  }
  static ComputePipeline scale_pipeline() {
    const std::uint32_t constants[] = {3, 64};
    return ComputePipeline(device(), "scale", compile_glsl_text(kScaleShader, "scale.comp"), constants);
  }
  static std::vector<std::uint32_t> read(const Buffer& from) {
    std::vector<std::uint32_t> values(kCount);
    from.read(std::as_writable_bytes(std::span(values)));
    return values;
  }
};

/// A chain that doubles back: every dispatch reads what the one before wrote and overwrites what it read.
void record_chain(Recorder& recorder, const ComputePipeline& scale, const DescriptorSet& forth,
                  const DescriptorSet& back, int rounds) {
  const Push push{1, kCount};
  for (int r = 0; r < rounds; ++r) {
    recorder.dispatch(scale, forth, kCount / 64, 1, std::as_bytes(std::span(&push, 1)));
    recorder.dispatch(scale, back, kCount / 64, 1, std::as_bytes(std::span(&push, 1)));
  }
}

// x → 3x + 1 twenty times on 32-bit words; the host does the same.
TEST_F(Compute, ChainOfDispatchesGivesTheRightResultAndIsSilent) {
  const ComputePipeline scale = scale_pipeline();
  Buffer a = buffer("a"), b = buffer("b");
  const DescriptorSet forth(device(), scale, std::vector<BoundBuffer>{{3, &a}, {7, &b}});
  const DescriptorSet back(device(), scale, std::vector<BoundBuffer>{{3, &b}, {7, &a}});
  std::vector<std::uint32_t> expected(kCount);
  std::iota(expected.begin(), expected.end(), 0u);
  a.write(std::as_bytes(std::span(expected)));

  Commands commands(device(), "chain", Reuse::many);
  std::uint64_t barriers = 0, dispatches = 0;
  commands.record([&](VkCommandBuffer handle) {
    Recorder recorder(device(), handle);
    recorder.label("chain");
    record_chain(recorder, scale, forth, back, 5);
    recorder.finish();
    barriers = recorder.barrier_count();
    dispatches = recorder.dispatch_count();
  });
  device().submit(commands.handle());
  device().wait(device().submit(commands.handle()));  // resubmitted, as recorded substeps are

  for (auto& x : expected)
    for (int i = 0; i < 20; ++i) x = 3 * x + 1;
  EXPECT_EQ(read(a), expected);
  EXPECT_EQ(dispatches, 10u);
  EXPECT_EQ(barriers, 9u);  // one between any two neighbours
}

// The same chain without barriers is a hazard that synchronization validation must report: this proves
// that the silence of the other tests means something.
TEST_F(Compute, SynchronizationValidationSeesMissingBarriers) {
  const ComputePipeline scale = scale_pipeline();
  Buffer a = buffer("a"), b = buffer("b");
  const DescriptorSet forth(device(), scale, std::vector<BoundBuffer>{{3, &a}, {7, &b}});
  const DescriptorSet back(device(), scale, std::vector<BoundBuffer>{{3, &b}, {7, &a}});
  Commands commands(device(), "chain without barriers");
  commands.record([&](VkCommandBuffer handle) {
    Recorder recorder(device(), handle, Barriers::none);
    record_chain(recorder, scale, forth, back, 1);
    recorder.finish();
    EXPECT_EQ(recorder.barrier_count(), 0u);
  });
  const auto messages = device().validation_messages();
  ASSERT_FALSE(messages.empty());
  EXPECT_NE(messages.front().find("SYNC-HAZARD"), std::string::npos) << messages.front();
  device().clear_validation_messages();
}

/// Dispatches into b, then copies b to a third buffer in the same command buffer.
class DispatchThenCopy {
 public:
  explicit DispatchThenCopy(Device& device)
      : device_(device),
        scale_(device, "scale", compile_glsl_text(kScaleShader, "scale.comp"), kConstants),
        a_(make("a")),
        b_(make("b")),
        copy_(make("copy")),
        set_(device, scale_, std::vector<BoundBuffer>{{3, &a_}, {7, &b_}}) {
    const std::vector<std::uint32_t> twos(kCount, 2u);
    a_.write(std::as_bytes(std::span(twos)));
  }
  void run(bool finish) {
    device_.run_once([&](VkCommandBuffer handle) {
      Recorder recorder(device_, handle);
      const Push push{5, kCount};
      recorder.dispatch(scale_, set_, kCount / 64, 1, std::as_bytes(std::span(&push, 1)));
      if (finish) recorder.finish();
      const VkBufferCopy whole{0, 0, kCount * 4};
      vkCmdCopyBuffer(handle, b_.handle(), copy_.handle(), 1, &whole);
    });
  }
  const Buffer& copy() const { return copy_; }

 private:
  static constexpr std::uint32_t kConstants[] = {3, 64};
  Buffer make(const char* name) {
    constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                          VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    return Buffer(device_, name, kCount * 4, kUsage, Memory::device);
  }
  Device& device_;
  ComputePipeline scale_;
  Buffer a_, b_, copy_;
  DescriptorSet set_;
};

// 3·2 + 5 = 11 must reach the copy, and the fixture sees that validation is silent.
TEST_F(Compute, FinishOrdersWhatReadsAfterTheDispatches) {
  DispatchThenCopy work(device());
  work.run(true);
  EXPECT_EQ(read(work.copy()), std::vector<std::uint32_t>(kCount, 11u));
}

// Without finish() the same copy is a read after write that validation must report.
TEST_F(Compute, SynchronizationValidationSeesThatFinishIsMissing) {
  DispatchThenCopy work(device());
  work.run(false);
  const auto messages = device().validation_messages();
  ASSERT_FALSE(messages.empty());
  EXPECT_NE(messages.front().find("SYNC-HAZARD-READ-AFTER-WRITE"), std::string::npos) << messages.front();
  device().clear_validation_messages();
}

// Two dispatches that only share what both read need no barrier; a third that overwrites it does (WAR).
TEST_F(Compute, BarriersStandOnlyWhereNeeded) {
  const ComputePipeline scale = scale_pipeline();
  Buffer a = buffer("a"), b = buffer("b"), c = buffer("c");
  const DescriptorSet a_to_b(device(), scale, std::vector<BoundBuffer>{{3, &a}, {7, &b}});
  const DescriptorSet a_to_c(device(), scale, std::vector<BoundBuffer>{{3, &a}, {7, &c}});
  const DescriptorSet c_to_a(device(), scale, std::vector<BoundBuffer>{{3, &c}, {7, &a}});
  const Push push{0, kCount};
  const auto bytes = std::as_bytes(std::span(&push, 1));
  const std::vector<std::uint32_t> ones(kCount, 1u);
  a.write(std::as_bytes(std::span(ones)));
  device().run_once([&](VkCommandBuffer handle) {
    Recorder recorder(device(), handle);
    recorder.dispatch(scale, a_to_b, kCount / 64, 1, bytes);
    recorder.dispatch(scale, a_to_c, kCount / 64, 1, bytes);
    EXPECT_EQ(recorder.barrier_count(), 0u);
    recorder.dispatch(scale, c_to_a, kCount / 64, 1, bytes);
    EXPECT_EQ(recorder.barrier_count(), 1u);  // c was written, a was read
    recorder.dispatch(scale, a_to_b, kCount / 64, 1, bytes);
    EXPECT_EQ(recorder.barrier_count(), 2u);  // a was written
    recorder.dispatch(scale, a_to_b, kCount / 64, 1, bytes);
    EXPECT_EQ(recorder.barrier_count(), 3u);  // b was written: write after write
    recorder.finish();
  });
  EXPECT_EQ(read(b), std::vector<std::uint32_t>(kCount, 27u));
}

// The same 16 bytes through a samplerBuffer; the format belongs to the view.
TEST_F(Compute, TexelBuffersReadWhatStorageBuffersHold) {
  constexpr const char* kText = R"(#version 460
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform samplerBuffer from;
layout(set = 0, binding = 1) restrict writeonly buffer To { float to[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < to.length()) to[i] = texelFetch(from, int(i >> 2))[i & 3u];
}
)";
  const ComputePipeline fetch(device(), "fetch", compile_glsl_text(kText, "fetch.comp"), {});
  Buffer from(device(), "from", kCount * 4,
              VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT, Memory::device);
  Buffer to = buffer("to");
  std::vector<float> values(kCount), got(kCount);
  std::iota(values.begin(), values.end(), 0.5f);
  from.write(std::as_bytes(std::span(values)));
  const DescriptorSet set(device(), fetch, std::vector<BoundBuffer>{{0, &from}, {1, &to}});
  device().run_once([&](VkCommandBuffer handle) {
    Recorder recorder(device(), handle);
    recorder.dispatch(fetch, set, kCount / 64, 1);
    recorder.finish();
  });
  to.read(std::as_writable_bytes(std::span(got)));
  EXPECT_EQ(got, values);
  EXPECT_EQ(from.texel_view(VK_FORMAT_R32G32B32A32_SFLOAT), from.texel_view(VK_FORMAT_R32G32B32A32_SFLOAT));
}

// Staging must carry what a shader wrote, on a device that never maps its memory.
TEST_F(Compute, ResultsComeBackThroughStaging) {
  const auto staged = make_device(true);
  {
    const std::uint32_t constants[] = {3, 64};
    const ComputePipeline scale(*staged, "scale", compile_glsl_text(kScaleShader, "scale.comp"), constants);
    Buffer a(*staged, "a", kCount * 4, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::device);
    Buffer b(*staged, "b", kCount * 4, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::device);
    ASSERT_EQ(a.mapped(), nullptr);
    const std::vector<std::uint32_t> twos(kCount, 2u);
    a.write(std::as_bytes(std::span(twos)));
    const DescriptorSet set(*staged, scale, std::vector<BoundBuffer>{{3, &a}, {7, &b}});
    const Push push{5, kCount};
    staged->run_once([&](VkCommandBuffer handle) {
      Recorder recorder(*staged, handle);
      recorder.dispatch(scale, set, kCount / 64, 1, std::as_bytes(std::span(&push, 1)));
    });
    EXPECT_EQ(read(b), std::vector<std::uint32_t>(kCount, 11u));
  }
  expect_silence(*staged);
}

TEST_F(Compute, MistakesAreRefusedBeforeVulkanSeesThem) {
  const ComputePipeline scale = scale_pipeline();
  Buffer a = buffer("a"), b = buffer("b");
  EXPECT_THROW(DescriptorSet(device(), scale, std::vector<BoundBuffer>{{3, &a}}), Error);
  const DescriptorSet set(device(), scale, std::vector<BoundBuffer>{{3, &a}, {7, &b}});
  device().run_once([&](VkCommandBuffer handle) {
    Recorder recorder(device(), handle);
    EXPECT_THROW(recorder.dispatch(scale, set, 1, 1), Error);  // push constants missing
    const std::byte push[8] = {};
    EXPECT_THROW(recorder.dispatch(scale, set, 1, device().limits().maxComputeWorkGroupCount[1] + 1, push),
                 Error);
    EXPECT_EQ(recorder.dispatch_count(), 0u);
  });
  const std::uint32_t too_wide[] = {3, device().limits().maxComputeWorkGroupSize[0] + 1};
  try {
    const ComputePipeline wide(device(), "scale", compile_glsl_text(kScaleShader, "scale.comp"), too_wide);
    FAIL() << "a workgroup over the limit was accepted";
  } catch (const Error& problem) {
    EXPECT_EQ(problem.code(), Exit::no_device);
  }
}

TEST_F(Compute, TimestampsOfAFinishedDispatchArePositive) {
  if (device().timestamp_ns() == 0.0) GTEST_SKIP() << "the device has no timestamps";
  const ComputePipeline scale = scale_pipeline();
  Buffer a = buffer("a"), b = buffer("b");
  const DescriptorSet set(device(), scale, std::vector<BoundBuffer>{{3, &a}, {7, &b}});
  Timer timer(device(), 2);
  const Push push{1, kCount};
  device().run_once([&](VkCommandBuffer handle) {
    timer.reset(handle);
    timer.stamp(handle, 0);
    Recorder recorder(device(), handle);
    recorder.dispatch(scale, set, kCount / 64, 1, std::as_bytes(std::span(&push, 1)));
    recorder.finish();
    timer.stamp(handle, 1);
  });
  EXPECT_GT(timer.between_ms(0, 1), 0.0);
  EXPECT_LT(timer.between_ms(0, 1), 10000.0);  // a thousand words cannot take ten seconds

  Commands reset(device(), "reset");
  reset.record([&](VkCommandBuffer handle) { timer.reset(handle); });
  device().wait(device().submit(reset.handle()));
  EXPECT_LT(timer.between_ms(0, 1), 0.0);  // nothing stamped since
}

}  // namespace
}  // namespace weft
