// Where src/gpu says what is no error: the program's logger on stderr; stdout is for results alone.
// Internal to src/gpu.
#pragma once
#include <spdlog/spdlog.h>

#include <memory>

namespace weft::gpu {

/// The logger registered as "weft", made for stderr when nobody has registered one.
std::shared_ptr<spdlog::logger> log();

}  // namespace weft::gpu
