// PNG through stb, whose functions stay private to this file.
#include "render/image.h"

#include <cstring>
#include <memory>
#include <string>

#include "core/error.h"
#include "core/file.h"

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_image.h>
#include <stb_image_write.h>
#pragma GCC diagnostic pop

namespace weft {

void write_png(const std::filesystem::path& file, const Picture& picture) {
  const std::size_t pixels = std::size_t{picture.width} * picture.height;
  WEFT_ASSERT(pixels > 0 && picture.rgba.size() == 4 * pixels);
  std::vector<std::uint8_t> rgb(3 * pixels);
  for (std::size_t p = 0; p < pixels; ++p) std::memcpy(&rgb[3 * p], &picture.rgba[4 * p], 3);
  std::string bytes;
  const auto append = [](void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(data),
                                               static_cast<std::size_t>(size));
  };
  const int width = static_cast<int>(picture.width);
  if (stbi_write_png_to_func(append, &bytes, width, static_cast<int>(picture.height), 3, rgb.data(),
                             3 * width) == 0)
    throw error(Exit::io,
                "{}: a picture of {}x{} pixels could not be packed into a PNG; try a smaller --size",
                file.string(), picture.width, picture.height);
  write_file(file, bytes);
}

Picture read_png(const std::filesystem::path& file) {
  const std::string bytes = read_file(file);
  int width = 0, height = 0, channels = 0;
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()), static_cast<int>(bytes.size()),
                            &width, &height, &channels, 4),
      stbi_image_free);
  if (!pixels) throw error(Exit::io, "{}: not a readable PNG ({})", file.string(), stbi_failure_reason());
  Picture picture{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
  picture.rgba.assign(pixels.get(), pixels.get() + std::size_t{4} * picture.width * picture.height);
  return picture;
}

}  // namespace weft
