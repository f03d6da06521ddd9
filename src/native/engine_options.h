// What a person or a test may choose about the native engine.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace weft::native {

struct EngineOptions {
  std::uint32_t threads = 0;  ///< exactly that many; 0: by trial, at most WEFT_THREADS and one a core
  std::string vector;         ///< a kernel's name; empty: WEFT_VECTOR, else the widest
  /// How fast each thread is taken to be until its work has been timed, relative to the others; those not
  /// named 1.
  std::vector<double> speeds;
  /// Whether frames in which the cloth stays spread out may be swept without self-collision's passes
  /// (SpreadWatch); no bit depends on it.
  bool spread_frames = true;
};

}  // namespace weft::native
