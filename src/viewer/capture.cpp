// File names and the film's clock.
#include "viewer/capture.h"

#include <fmt/format.h>

#include "core/error.h"

namespace weft {
namespace {

/// H.264 with halved colour needs even sides: the last row or column is left out.
Picture with_even_sides(Picture picture) {
  const std::uint32_t width = picture.width & ~1u, height = picture.height & ~1u;
  if (width == picture.width && height == picture.height) return picture;
  Picture even{.width = width, .height = height, .rgba = {}};
  for (std::uint32_t y = 0; y < height; ++y) {
    const auto row = picture.rgba.begin() + static_cast<std::ptrdiff_t>(std::size_t{y} * picture.width * 4);
    even.rgba.insert(even.rgba.end(), row, row + static_cast<std::ptrdiff_t>(std::size_t{width} * 4));
  }
  return even;
}

}  // namespace

std::filesystem::path free_name(const std::filesystem::path& dir, const char* extension) {
  for (int number = 1;; ++number) {
    std::filesystem::path file = dir / fmt::format("weft-{:04}.{}", number, extension);
    if (!std::filesystem::exists(file)) return file;
  }
}

void Film::add(Picture picture, double elapsed_s) {
  picture = with_even_sides(std::move(picture));
  if (!writer_) {
    width_ = picture.width;
    height_ = picture.height;
    writer_ = std::make_unique<VideoWriter>(file_, width_, height_, kFps);
  }
  if (picture.width != width_ || picture.height != height_)
    throw error(Exit::usage, "{}: the picture's size changed from {} x {} to {} x {}; the film ends here",
                file_.string(), width_, height_, picture.width, picture.height);
  while (wants(elapsed_s)) {
    writer_->add(picture);
    ++pictures_;
  }
}

void Film::finish() {
  if (!writer_) throw error(Exit::io, "{}: no picture was filmed", file_.string());
  writer_->finish();
  writer_.reset();
}

}  // namespace weft
