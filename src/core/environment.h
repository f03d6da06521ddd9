// Environment variables that hold a number.
#pragma once
#include <cstdint>
#include <limits>
#include <optional>

namespace weft {

/// The whole number in an environment variable; nothing when it is not set.
/// @throws Error(Exit::usage) when it is set, even to nothing, and no whole number from `least` to `most`
std::optional<std::uint64_t> environment_number(
    const char* name, std::uint64_t least = 0,
    std::uint64_t most = std::numeric_limits<std::uint64_t>::max());

}  // namespace weft
