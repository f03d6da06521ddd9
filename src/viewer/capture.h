// Pictures and films of the window: names that are free, and a film at a steady rate of wall time.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>

#include "render/picture.h"
#include "render/video.h"

namespace weft {

/// DIR/weft-0001.png, or the next number that is free.
std::filesystem::path free_name(const std::filesystem::path& dir, const char* extension);

/// A film that shows what the window showed, at kFps pictures a second of wall time: a slow picture is
/// repeated, a quick one left out.
class Film {
 public:
  static constexpr double kFps = 30.0;
  explicit Film(std::filesystem::path file) : file_(std::move(file)) {}
  /// Whether the film needs a picture at this wall time [s] since it began.
  bool wants(double elapsed_s) const { return elapsed_s * kFps >= static_cast<double>(pictures_); }
  /// @throws Error(Exit::io) as VideoWriter does; Error(Exit::usage) when the size changed
  void add(Picture picture, double elapsed_s);
  /// @throws Error(Exit::io) when ffmpeg failed, or no picture came
  void finish();
  const std::filesystem::path& file() const { return file_; }
  std::uint64_t pictures() const { return pictures_; }

 private:
  std::filesystem::path file_;
  std::unique_ptr<VideoWriter> writer_;
  std::uint32_t width_ = 0, height_ = 0;
  std::uint64_t pictures_ = 0;
};

}  // namespace weft
