// Where pictures go: one PNG, a numbered sequence of PNGs, or an MP4, as the name of the file says.
#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "render/picture.h"

namespace weft {

enum class OutputKind {
  picture,   ///< FILE.png: the last picture only
  sequence,  ///< DIR/frame-%04d.png: every picture, numbered from 0
  video,     ///< FILE.mp4
};

/// @throws Error(Exit::usage) when the name ends in neither .png nor .mp4, or has a wrong number field
OutputKind output_kind(const std::string& name);

class PictureOutput {
 public:
  virtual ~PictureOutput() = default;
  /// @throws Error(Exit::io)
  virtual void add(const Picture& picture) = 0;
  /// Completes the file; without it no half-written file stays behind.
  /// @throws Error(Exit::io)
  virtual void finish() = 0;
};

/// Opens early, so that an impossible place is reported before anything is computed. Only a sequence makes
/// its folder.
/// @param fps  pictures a second of a video; others ignore it
/// @throws Error(Exit::usage) as output_kind() and VideoWriter do; Error(Exit::io) when it cannot be written
std::unique_ptr<PictureOutput> open_output(const std::string& name, std::uint32_t width, std::uint32_t height,
                                           double fps);

/// The name of picture `number`: "frame-%04d.png" and 7 give "frame-0007.png".
std::string sequence_name(const std::string& pattern, std::uint64_t number);

}  // namespace weft
