// How many of the machine's cores this program may use.
#pragma once
#include <cstdint>

namespace weft {

/// Those that the system lets the calling thread run on (taskset, a container's set of cores), at least 1.
/// The standard library counts all of the machine's; threads beyond the allowed ones only wait for each
/// other.
std::uint32_t usable_cores();

}  // namespace weft
