// Lines that say what the window is doing, for tests and bug reports: `state key=value …`, one on every
// change of what a person can change and a few a second besides.
#pragma once
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

namespace weft {

class StateLog {
 public:
  StateLog() = default;
  /// @throws Error(Exit::io) when the file cannot be written; an empty path logs nothing
  explicit StateLog(const std::filesystem::path& file);
  bool on() const { return file_.is_open(); }
  /// @param settings  what a person changes; a new value is written at once
  /// @param figures   what changes by itself; written a few times a second
  /// @return          whether a line was written
  bool state(const std::string& settings, const std::string& figures);
  void event(const std::string& text);

 private:
  std::ofstream file_;
  std::string settings_;
  std::chrono::steady_clock::time_point next_{};
};

}  // namespace weft
