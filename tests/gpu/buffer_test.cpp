// Bytes that go to the device and come back, mapped and staged; limits; images.
#include "gpu/buffer.h"

#include <cstring>
#include <random>
#include <vector>

#include "gpu_fixture.h"

namespace weft {
namespace {

using namespace gpu;

std::vector<std::byte> noise(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::byte> bytes(count);
  for (std::byte& b : bytes) b = static_cast<std::byte>(random() & 0xffu);
  return bytes;
}

class Buffers : public test::GpuTest {
 protected:
  /// Writes noise, overwrites a piece in the middle, reads the whole and a piece back.
  static void round_trip(Device& device, std::size_t count, Memory memory) {
    Buffer buffer(device, "round trip", count, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, memory);
    std::vector<std::byte> expected = noise(count, 1);
    buffer.write(expected);
    const std::vector<std::byte> piece = noise(count / 4, 2);
    buffer.write(piece, count / 3);
    std::copy(piece.begin(), piece.end(), expected.begin() + static_cast<std::ptrdiff_t>(count / 3));
    std::vector<std::byte> got(count);
    buffer.read(got);
    EXPECT_EQ(got, expected);
    std::vector<std::byte> part(count / 5);
    buffer.read(part, count / 2);
    EXPECT_EQ(std::memcmp(part.data(), expected.data() + count / 2, part.size()), 0);
  }
};

TEST_F(Buffers, RoundTripInEveryMemory) {
  for (const Memory memory : {Memory::device, Memory::upload, Memory::readback})
    for (const std::size_t count : {std::size_t{24}, std::size_t{100001}})
      round_trip(device(), count, memory);
}

// 40 MiB is more than two staging pieces of 16 MiB, with a rest.
TEST_F(Buffers, RoundTripThroughStaging) {
  const auto staged = make_device(true);
  {
    const Buffer hidden(*staged, "hidden", 64, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::device);
    const Buffer upload(*staged, "upload", 64, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::upload);
    const Buffer readback(*staged, "readback", 64, 0, Memory::readback);
    EXPECT_EQ(hidden.mapped(), nullptr);
    EXPECT_NE(upload.mapped(), nullptr);
    EXPECT_NE(readback.mapped(), nullptr);
  }
  for (const std::size_t count : {std::size_t{24}, std::size_t{100001}, std::size_t{40} << 20})
    round_trip(*staged, count, Memory::device);
  EXPECT_EQ(staged->allocator().live_count(), 0u);
  expect_silence(*staged);
}

TEST_F(Buffers, EnvironmentForcesStaging) {
  const test::ScopedEnvironment force("WEFT_FORCE_STAGING", "1");
  const auto staged = make_device();
  const Buffer hidden(*staged, "hidden", 64, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::device);
  EXPECT_EQ(hidden.mapped(), nullptr);
}

TEST_F(Buffers, ReadingOrWritingPastTheEndIsRefused) {
  Buffer buffer(device(), "short", 64, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::device);
  std::vector<std::byte> bytes(64);
  EXPECT_THROW(buffer.write(bytes, 1), Error);
  EXPECT_THROW(buffer.read(bytes, 1), Error);
  EXPECT_THROW(buffer.read(bytes, ~VkDeviceSize{0}), Error);
  EXPECT_THROW(Buffer(device(), "empty", 0, 0, Memory::device), Error);
}

TEST_F(Buffers, TheDevicesLimitIsNamedBeforeAnythingIsAllocated) {
  const auto before = device().allocator().live_count();
  const VkDeviceSize bytes = VkDeviceSize{device().limits().maxStorageBufferRange} + 1;
  try {
    const Buffer buffer(device(), "huge", bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::device);
    FAIL() << "a buffer over the limit was made";
  } catch (const Error& problem) {
    EXPECT_EQ(problem.code(), Exit::no_device);
    EXPECT_NE(std::string(problem.what()).find(std::to_string(bytes)), std::string::npos) << problem.what();
  }
  EXPECT_EQ(device().allocator().live_count(), before);
}

TEST_F(Buffers, ImagesKeepTheirPixels) {
  ImageOptions options;
  options.width = 37;
  options.height = 21;
  options.usage =
      VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  const Image image(device(), "pixels", options);
  const auto pixels = noise(37 * 21 * 4, 3);
  write_image(device(), image, pixels, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  EXPECT_EQ(read_image(device(), image, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL), pixels);
  EXPECT_EQ(read_image(device(), image, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL), pixels);
  EXPECT_THROW(write_image(device(), image, std::span(pixels).first(4), VK_IMAGE_LAYOUT_GENERAL), Error);
  options.width = 0;
  EXPECT_THROW(Image(device(), "no width", options), Error);
}

TEST_F(Buffers, MovingHandsTheMemoryOver) {
  const auto before = device().allocator().live_count();
  {
    Buffer first(device(), "first", 64, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::upload);
    Buffer second(device(), "second", 128, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, Memory::upload);
    second = std::move(first);
    EXPECT_EQ(second.name(), "first");
    EXPECT_EQ(second.bytes(), 64u);
  }
  EXPECT_EQ(device().allocator().live_count(), before);
}

}  // namespace
}  // namespace weft
