// The pipeline cache on disk: kept when whole, ignored and rewritten when damaged, harmless when unwritable.
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>

#include "gpu/pipeline.h"
#include "gpu_fixture.h"

namespace weft {
namespace {

using namespace gpu;
using Bytes = std::vector<char>;

/// FNV-1a from a byte on, as the file format states.
std::uint64_t fnv(const Bytes& bytes, std::size_t from) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (std::size_t i = from; i < bytes.size(); ++i)
    hash = (hash ^ static_cast<unsigned char>(bytes[i])) * 0x100000001b3u;
  return hash;
}

class CacheFile : public test::GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    std::filesystem::remove_all(folder_);
  }
  void TearDown() override {
    std::filesystem::remove_all(folder_);
    GpuTest::TearDown();
  }
  Bytes content() const {
    std::ifstream stream(file_, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  void replace(const Bytes& bytes) const {
    std::ofstream(file_, std::ios::binary | std::ios::trunc)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  /// Opens, notes whether the file was taken, and closes, which saves.
  bool open_and_close() {
    const PipelineCache cache(device(), folder_);
    file_ = cache.file();
    return cache.loaded();
  }

  const std::filesystem::path folder_ = std::filesystem::path(WEFT_BINARY_DIR) / "test-pipeline-cache";
  std::filesystem::path file_;
};

TEST_F(CacheFile, IsWrittenAndTakenAgain) {
  EXPECT_FALSE(open_and_close());
  EXPECT_TRUE(open_and_close());
  EXPECT_TRUE(open_and_close());
  // Nothing but the file itself: the temporary name is gone.
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
}

// The file's head is 24 bytes of ours, then Vulkan's: length, version, vendor, device, 16 bytes of UUID.
TEST_F(CacheFile, DamagedTruncatedOrForeignIsIgnoredAndRewritten) {
  open_and_close();
  const Bytes whole = content();
  ASSERT_GE(whole.size(), 24u + 32u);
  const std::pair<const char*, std::function<void(Bytes&)>> damages[] = {
      {"empty", [](Bytes& b) { b.clear(); }},
      {"half a header", [](Bytes& b) { b.resize(10); }},
      {"cut", [](Bytes& b) { b.pop_back(); }},
      {"longer", [](Bytes& b) { b.push_back('x'); }},
      {"other magic", [](Bytes& b) { b[0] = 'X'; }},
      {"other vendor", [](Bytes& b) { b[24 + 8] = static_cast<char>(b[24 + 8] ^ 1); }},
      {"one bit at the end", [](Bytes& b) { b.back() = static_cast<char>(b.back() ^ 1); }},
  };
  for (const auto& [name, damage] : damages) {
    SCOPED_TRACE(name);
    Bytes bytes = whole;
    damage(bytes);
    replace(bytes);
    EXPECT_FALSE(open_and_close());
    EXPECT_EQ(content(), whole);
    EXPECT_TRUE(open_and_close());
  }
}

// A payload behind Vulkan's 32 bytes, with the checksum right, is taken; with any one of its bits flipped,
// the length unchanged, it is not: drivers trust what they are given.
TEST_F(CacheFile, AnyFlippedBitOfTheDriversPayloadIsSeen) {
  constexpr std::size_t kHead = 24, kVulkanHead = 32;
  open_and_close();
  Bytes bytes = content();
  for (int i = 0; i < 4000; ++i) bytes.push_back(static_cast<char>(i * 37));
  const std::uint64_t length = bytes.size() - kHead, sum = fnv(bytes, kHead);
  std::memcpy(bytes.data() + 8, &length, sizeof length);
  std::memcpy(bytes.data() + 16, &sum, sizeof sum);
  replace(bytes);
  EXPECT_TRUE(PipelineCache(device(), folder_).loaded());
  const std::size_t payload = kHead + kVulkanHead;
  for (const std::size_t at : {payload, payload + 1, (payload + bytes.size()) / 2, bytes.size() - 1})
    for (const int bit : {0, 7}) {
      Bytes damaged = bytes;
      damaged[at] = static_cast<char>(damaged[at] ^ (1 << bit));
      replace(damaged);
      EXPECT_FALSE(open_and_close()) << "byte " << at << ", bit " << bit;
    }
}

// A cache of another driver is whole by its checksum, and still not ours: the UUID in Vulkan's header says
// so.
TEST_F(CacheFile, AWholeFileOfAnotherDeviceIsIgnored) {
  open_and_close();
  Bytes bytes = content();
  bytes[24 + 16] = static_cast<char>(bytes[24 + 16] ^ 1);
  const std::uint64_t hash = fnv(bytes, 24);
  std::memcpy(bytes.data() + 16, &hash, sizeof hash);
  replace(bytes);
  EXPECT_FALSE(open_and_close());
}

TEST_F(CacheFile, AnUnwritableFolderIsNoError) {
  std::filesystem::create_directories(folder_);
  const auto blocked = folder_ / "a file";
  std::ofstream(blocked) << "in the way";
  EXPECT_NO_THROW({
    PipelineCache cache(device(), blocked / "weft");
    cache.save();
  });
}

}  // namespace
}  // namespace weft
