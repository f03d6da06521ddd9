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

}  // namespace
}  // namespace weft
