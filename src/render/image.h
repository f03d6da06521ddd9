// PNG files, written whole or not at all.
#pragma once
#include <filesystem>

#include "render/picture.h"

namespace weft {

/// Writes a PNG (8 bits, RGB): under a temporary name first, then renamed.
/// @throws Error(Exit::io) when the folder is missing or the file cannot be written
void write_png(const std::filesystem::path& file, const Picture& picture);

/// Reads any PNG as 8-bit RGBA.
/// @throws Error(Exit::io) when it cannot be read or is no PNG
Picture read_png(const std::filesystem::path& file);

}  // namespace weft
