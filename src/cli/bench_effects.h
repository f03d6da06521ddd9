// `weft bench --effects`: each effect with and without it.
#pragma once
#include "cli/command.h"

namespace weft::cli {

/// On native where that is the default or named, else on a Vulkan device.
/// @throws Error(Exit::no_device) for a Vulkan device without timestamps, or without any that was named
Exit run_effect_bench(const Options&);

}  // namespace weft::cli
