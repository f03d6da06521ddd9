// libFuzzer target for the scene reader: any bytes end in a scene or in a usage error, nothing else. The
// first line may hold one override; seeds are the files of assets/scenes. Run: build with clang and
// -DWEFT_FUZZ=ON, then `fuzz_scene_reader -max_len=4096 CORPUS assets/scenes`.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "core/error.h"
#include "scene/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view text(reinterpret_cast<const char*>(data), size);
  weft::SceneOverrides overrides;
  constexpr std::string_view kMark = "#--set ";  // a comment to TOML, so that seeds stay scenes
  if (text.starts_with(kMark)) {
    const std::string_view line = text.substr(0, text.find('\n'));
    overrides.set.emplace_back(line.substr(kMark.size()));
  }
  try {
    weft::parse_scene(text, "fuzz.toml", overrides);
  } catch (const weft::Error& refusal) {
    if (refusal.code() != weft::Exit::usage) std::abort();
  }
  return 0;
}
