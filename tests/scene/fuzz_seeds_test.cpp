// The fuzzer's target on its seeds, with any compiler: none of them crashes the reader, and a scene is a
// scene to it.
#include <gtest/gtest.h>

#include <filesystem>

#include "core/file.h"
#include "fuzz/scene_reader.cpp"

namespace weft {
namespace {

namespace fs = std::filesystem;

TEST(FuzzSeeds, EndInASceneOrAUsageError) {
  int seeds = 0;
  for (const char* folder : {"/assets/scenes", "/tests/hard_cases", "/tests/fuzz/corpus"})
    for (const auto& entry : fs::directory_iterator(std::string(WEFT_SOURCE_DIR) + folder)) {
      if (entry.path().extension() != ".toml") continue;
      const std::string text = read_file(entry.path());
      EXPECT_EQ(LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()), 0)
          << entry.path();
      ++seeds;
    }
  EXPECT_GE(seeds, 30);
}

}  // namespace
}  // namespace weft
