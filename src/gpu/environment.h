// Debug switches read from the environment. Internal to src/gpu.
#pragma once
#include <cstdint>
#include <optional>

namespace weft::gpu {

/// The whole number in an environment variable; nothing when it is not set.
/// @throws Error(Exit::usage) when it is set and no whole number of at least 0.
std::optional<std::uint64_t> environment_number(const char* name);

}  // namespace weft::gpu
