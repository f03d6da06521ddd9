// `weft bench --effects`: each effect with and without it.
#pragma once
#include "cli/command.h"

namespace weft::cli {

/// @throws Error(Exit::no_device) without a Vulkan device that has timestamps
Exit run_effect_bench(const Options&);

}  // namespace weft::cli
