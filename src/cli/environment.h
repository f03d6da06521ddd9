// The environment variables that every command heeds, checked before it runs.
#pragma once

namespace weft::cli {

/// Refuses a value that no command could use, whether or not this one would have asked for it.
/// @throws Error(Exit::usage) naming variable, value, rule and cure
void check_environment();

}  // namespace weft::cli
