// Where src/gpu says what is no error: the program's logger on stderr; stdout is for results alone.
#pragma once
#include <spdlog/spdlog.h>

#include <memory>

namespace weft::gpu {

/// The logger registered as "weft", made for stderr when nobody has registered one.
std::shared_ptr<spdlog::logger> log();

/// Whether only failures are said, and no warnings (the command line's --quiet).
void set_quiet(bool quiet);

}  // namespace weft::gpu
