// Whether this is the full run: what takes long, or asks how fast the machine is, waits for it.
#pragma once
#include <cstdlib>

namespace weft::test {

/// `scripts/test --full` sets WEFT_FULL.
inline bool full_run() { return std::getenv("WEFT_FULL") != nullptr; }

}  // namespace weft::test
