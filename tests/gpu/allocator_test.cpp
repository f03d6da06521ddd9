// The allocator under random load, and when memory is out.
#include <random>
#include <set>
#include <vector>

#include "gpu/buffer.h"
#include "gpu_fixture.h"

namespace weft {
namespace {

using namespace gpu;
using Allocation = Allocator::Allocation;

class Allocators : public test::GpuTest {};

struct Held {
  Allocation allocation;
  bool image;
};

/// Same memory object and overlapping bytes.
bool overlap(const Allocation& a, const Allocation& b) {
  return a.memory == b.memory && a.offset < b.offset + b.size && b.offset < a.offset + a.size;
}

VkMemoryRequirements random_needs(std::mt19937& random) {
  VkMemoryRequirements needs{};
  const auto bits = random() % 24;  // up to 16 MiB, small ones as likely as large ones
  needs.size = 1 + random() % (std::uint64_t{1} << bits);
  needs.alignment = VkDeviceSize{1} << (random() % 13);
  needs.memoryTypeBits = ~0u;
  return needs;
}

// What must hold after every step: aligned, disjoint, images and buffers in different memory, counts right.
TEST_F(Allocators, RandomLoadNeverOverlapsAndReturnsEverything) {
  Allocator allocator(device(), false);
  std::mt19937 random(7);
  std::vector<Held> held;
  std::uint64_t bytes = 0;
  for (int step = 0; step < 3000; ++step) {
    if (held.size() < 60 && (held.empty() || random() % 2 == 0)) {
      const VkMemoryRequirements needs = random_needs(random);
      const bool image = random() % 3 == 0;
      const auto memory = static_cast<Memory>(random() % 3);
      const Allocation fresh = allocator.allocate(needs, memory, image, "stress");
      ASSERT_EQ(fresh.offset % needs.alignment, 0u);
      ASSERT_GE(fresh.size, needs.size);
      for (const Held& other : held) {
        ASSERT_FALSE(overlap(fresh, other.allocation)) << "step " << step;
        ASSERT_FALSE(fresh.memory == other.allocation.memory && image != other.image) << "step " << step;
      }
      bytes += fresh.size;
      held.push_back({fresh, image});
    } else {
      const std::size_t which = random() % held.size();
      bytes -= held[which].allocation.size;
      allocator.release(held[which].allocation);
      held.erase(held.begin() + static_cast<std::ptrdiff_t>(which));
    }
    ASSERT_EQ(allocator.live_bytes(), bytes);
    ASSERT_EQ(allocator.live_count(), held.size());
    ASSERT_LE(allocator.live_bytes(), allocator.block_bytes());
  }
  for (const Held& h : held) allocator.release(h.allocation);
  EXPECT_EQ(allocator.live_bytes(), 0u);
  EXPECT_EQ(allocator.live_count(), 0u);
  // Only the first block of each memory type and kind may stay: 4 MiB, three kinds of memory, two uses.
  EXPECT_LE(allocator.block_bytes(), std::uint64_t{6} * (4u << 20));
}

// 4 MiB blocks first: a thousand buffers of 1 KiB are one driver allocation, one of 100 MiB is its own.
TEST_F(Allocators, SmallOnesShareABlockAndLargeOnesDoNot) {
  Allocator allocator(device(), false);
  VkMemoryRequirements needs{1024, 256, ~0u};
  std::vector<Allocation> small;
  for (int i = 0; i < 1000; ++i) small.push_back(allocator.allocate(needs, Memory::device, false, "small"));
  EXPECT_EQ(allocator.block_count(), 1u);
  needs.size = VkDeviceSize{100} << 20;
  const Allocation large = allocator.allocate(needs, Memory::device, false, "large");
  EXPECT_EQ(allocator.block_count(), 2u);
  allocator.release(large);
  EXPECT_EQ(allocator.block_count(), 1u);
  for (const Allocation& a : small) allocator.release(a);
  EXPECT_EQ(allocator.live_count(), 0u);
}

TEST_F(Allocators, MoreThanTheDeviceHasIsRefusedWithBothNumbers) {
  Allocator allocator(device(), false);
  const VkMemoryRequirements needs{allocator.heap_bytes() * 2, 256, ~0u};
  try {
    allocator.allocate(needs, Memory::device, false, "buffer too_big");
    FAIL() << "twice the device's memory was allocated";
  } catch (const Error& problem) {
    const std::string text = problem.what();
    EXPECT_EQ(problem.code(), Exit::no_device);
    EXPECT_NE(text.find("too_big"), std::string::npos) << text;
    EXPECT_NE(text.find(std::to_string(needs.size)), std::string::npos) << text;
    const double there_mib = static_cast<double>(allocator.heap_bytes()) / (1024.0 * 1024.0);
    EXPECT_NE(text.find(fmt::format("{:.1f} MiB", there_mib)), std::string::npos) << text;
  }
  EXPECT_EQ(allocator.live_count(), 0u);
}

// The debug switch stands for a full device: the third buffer of 1 MiB does not fit in 2.5 MiB, and the
// program can go on after one is released.
TEST_F(Allocators, SimulatedExhaustionIsAnErrorThatCanBeSurvived) {
  const test::ScopedEnvironment limit("WEFT_FAIL_ALLOCATION_AFTER_BYTES", "2621440");
  const auto small = make_device();
  {
    constexpr VkDeviceSize kMiB = VkDeviceSize{1} << 20;
    const auto make = [&] {
      return Buffer(*small, "filler", kMiB, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::device);
    };
    const Buffer first = make();
    {
      const Buffer second = make();
      try {
        make();
        FAIL() << "the third buffer fitted";
      } catch (const Error& problem) {
        EXPECT_EQ(problem.code(), Exit::no_device);
        EXPECT_NE(std::string(problem.what()).find("filler"), std::string::npos) << problem.what();
      }
      EXPECT_EQ(small->allocator().live_count(), 2u);
    }
    EXPECT_NO_THROW(make());
  }
  expect_silence(*small);
}

}  // namespace
}  // namespace weft
