// The progress bar: on stderr, only on a terminal, never with --quiet.
#pragma once
#include <chrono>
#include <cstdint>
#include <string>

namespace weft::cli {

class Progress {
 public:
  /// @param what  shown before the bar, for example the scene's title
  Progress(std::string what, bool quiet);
  ~Progress();  ///< wipes the line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Redraws at most ten times a second.
  void show(std::uint64_t done, std::uint64_t total);

 private:
  std::string what_;
  bool visible_, drawn_ = false;
  std::chrono::steady_clock::time_point started_, latest_;
};

}  // namespace weft::cli
