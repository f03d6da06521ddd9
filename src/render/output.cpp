// Chooses the kind of output by its name and writes it.
#include "render/output.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <optional>

#include "core/error.h"
#include "core/file.h"
#include "core/text.h"
#include "render/image.h"
#include "render/video.h"

namespace weft {
namespace {

namespace fs = std::filesystem;

/// A field like %04d or %d: where it stands and to how many digits it is filled.
struct NumberField {
  std::size_t begin = 0, end = 0, digits = 0;
};

std::optional<NumberField> find_field(const std::string& name) {
  NumberField field;
  field.begin = name.find('%');
  if (field.begin == std::string::npos) return std::nullopt;
  std::size_t at = field.begin + 1;
  const bool filled = at < name.size() && name[at] == '0';
  if (filled) ++at;
  while (at < name.size() && std::isdigit(static_cast<unsigned char>(name[at])) != 0 && at - field.begin < 5)
    field.digits = 10 * field.digits + static_cast<std::size_t>(name[at++] - '0');
  const bool whole = at < name.size() && name[at] == 'd' && field.digits <= 12 &&
                     (filled == (field.digits > 0)) && name.find('%', at) == std::string::npos &&
                     name.find('/', at) == std::string::npos;
  if (!whole)
    throw error(Exit::usage, "--out {}: a sequence needs one number field like %04d in the file's name",
                name);
  field.end = at + 1;
  return field;
}

std::string lower_extension(const std::string& name) {
  return in_lower_case(fs::path(name).extension().string());
}

/// Both an AtomicPath's checks and a try: nothing is left behind.
void require_writable(const fs::path& file) { AtomicFile probe(file); }

class LastPicture final : public PictureOutput {
 public:
  explicit LastPicture(fs::path file) : file_(std::move(file)) { require_writable(file_); }
  void add(const Picture& picture) override { last_ = picture; }
  void finish() override { write_png(file_, last_); }

 private:
  fs::path file_;
  Picture last_;
};

class Sequence final : public PictureOutput {
 public:
  explicit Sequence(std::string pattern) : pattern_(std::move(pattern)) {
    const fs::path folder = fs::path(pattern_).parent_path();
    std::error_code failure;
    if (!folder.empty()) fs::create_directories(folder, failure);
    if (failure)
      throw error(Exit::io, "{}: the folder cannot be made ({})", folder.string(), failure.message());
    require_writable(sequence_name(pattern_, 0));
  }
  void add(const Picture& picture) override { write_png(sequence_name(pattern_, number_++), picture); }
  void finish() override {}

 private:
  std::string pattern_;
  std::uint64_t number_ = 0;
};

class Video final : public PictureOutput {
 public:
  Video(const fs::path& file, std::uint32_t width, std::uint32_t height, double fps)
      : writer_(file, width, height, fps) {}
  void add(const Picture& picture) override { writer_.add(picture); }
  void finish() override { writer_.finish(); }

 private:
  VideoWriter writer_;
};

}  // namespace

OutputKind output_kind(const std::string& name) {
  const std::string extension = lower_extension(name);
  if (extension == ".mp4") return OutputKind::video;
  if (extension == ".png") return find_field(name) ? OutputKind::sequence : OutputKind::picture;
  throw error(Exit::usage,
              "--out {}: the name must end in .mp4 (a film) or .png (a picture; with %04d in its "
              "name a sequence)",
              name);
}

std::string sequence_name(const std::string& pattern, std::uint64_t number) {
  const std::optional<NumberField> field = find_field(pattern);
  if (!field) return pattern;
  return pattern.substr(0, field->begin) +
         fmt::format("{:0{}}", number, std::max<std::size_t>(field->digits, 1)) + pattern.substr(field->end);
}

std::unique_ptr<PictureOutput> open_output(const std::string& name, std::uint32_t width, std::uint32_t height,
                                           double fps) {
  switch (output_kind(name)) {
    case OutputKind::video: return std::make_unique<Video>(name, width, height, fps);
    case OutputKind::sequence: return std::make_unique<Sequence>(name);
    case OutputKind::picture: break;
  }
  return std::make_unique<LastPicture>(name);
}

}  // namespace weft
