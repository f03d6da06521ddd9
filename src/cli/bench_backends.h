// `weft bench --device native`: all backends side by side.
#pragma once
#include "cli/command.h"

namespace weft::cli {

/// @throws Error(Exit::usage) when native does not run a scene
Exit run_backend_bench(const Options&);

}  // namespace weft::cli
