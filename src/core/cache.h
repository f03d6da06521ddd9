// Where what can be computed anew is kept between runs.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string_view>

namespace weft {

/// $XDG_CACHE_HOME/weft, else ~/.cache/weft; empty where there is neither. It need not exist yet.
std::filesystem::path cache_folder();

/// FNV-1a, 64 bits, going on from `hash`.
std::uint64_t fnv1a_64(std::string_view bytes, std::uint64_t hash = 0xcbf29ce484222325u);

}  // namespace weft
