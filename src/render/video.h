// MP4 files: raw pictures are piped to the program ffmpeg (H.264), which writes under a temporary name.
#pragma once
#include <filesystem>
#include <memory>

#include "render/picture.h"

namespace weft {

class VideoWriter {
 public:
  /// Starts ffmpeg, found through PATH.
  /// @param fps  pictures a second of the film, positive
  /// @throws Error(Exit::usage) when width or height is odd, which the format cannot hold
  /// @throws Error(Exit::io)    when the folder is missing or ffmpeg is not installed
  VideoWriter(const std::filesystem::path& file, std::uint32_t width, std::uint32_t height, double fps);
  /// Without finish(): stops ffmpeg and leaves no file behind.
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  /// @throws Error(Exit::io) with ffmpeg's own words when it has stopped
  void add(const Picture& picture);
  /// Waits for ffmpeg and gives the film its name.
  /// @throws Error(Exit::io) with ffmpeg's own words when it failed
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace weft
