// Files read whole and written whole, through a temporary name and a rename.
#include "core/file.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "core/error.h"

namespace weft {
namespace fs = std::filesystem;
namespace {

/// Where writing must go: the file a link points to, so that the rename does not replace the link.
fs::path resolved(const fs::path& target) {
  std::error_code ignored;
  fs::path real = fs::weakly_canonical(target, ignored);
  if (ignored || real.empty()) return target;
  constexpr int kLinksMost = 40;  // as the kernel's own limit
  for (int links = 0; links < kLinksMost && fs::is_symlink(real, ignored); ++links) {  // to nothing, so far
    const fs::path next = fs::weakly_canonical(real.parent_path() / fs::read_symlink(real, ignored), ignored);
    if (next == real) break;
    real = next;
  }
  return real;
}

fs::path temporary_beside(const fs::path& target) {
  static std::atomic<unsigned> count{0};  // two files written at once never share a name
  const std::string name =
      fmt::format(".{}.{}-{}.part{}", target.stem().string(), getpid(), count++, target.extension().string());
  return target.parent_path() / name;
}

std::string reason() { return errno != 0 ? std::strerror(errno) : "unknown reason"; }

}  // namespace

AtomicPath::AtomicPath(const fs::path& target) : target_(resolved(target)) {
  std::error_code ignored;
  if (target.empty()) throw error(Exit::io, "cannot write a file without a name; give one");
  if (fs::is_directory(target_, ignored))
    throw error(Exit::io, "cannot write {}: it is a folder; name a file in it", target.string());
  const fs::path folder = target_.has_parent_path() ? target_.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, ignored))
    throw error(Exit::io, "cannot write {}: the folder {} does not exist; create it first", target.string(),
                target.has_parent_path() ? target.parent_path().string() : folder.string());
  if (fs::is_symlink(target_, ignored))
    throw error(Exit::io, "cannot write {}: the link leads in a circle; name a file", target.string());
  const bool special = fs::exists(target_, ignored) && !fs::is_regular_file(target_, ignored);
  if (special && !fs::is_character_file(target_, ignored))  // opening a pipe would wait for its reader
    throw error(Exit::io, "cannot write {}: it is neither a file nor a device such as /dev/null; name a file",
                target.string());
  temporary_ = special ? target_ : temporary_beside(target_);
}

AtomicPath::~AtomicPath() {
  if (committed_ || temporary_ == target_) return;
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void AtomicPath::commit() {
  if (temporary_ != target_) {
    std::error_code failure;
    fs::rename(temporary_, target_, failure);
    if (failure) throw error(Exit::io, "cannot write {}: {}", target_.string(), failure.message());
  }
  committed_ = true;
}

AtomicFile::AtomicFile(const fs::path& target) : path_(target) {
  errno = 0;
  stream_.open(path_.temporary(), std::ios::binary | std::ios::trunc);
  if (!stream_) throw error(Exit::io, "cannot write {}: {}", target.string(), reason());
}

void AtomicFile::commit() {
  errno = 0;
  stream_.close();  // sets failbit when the last bytes did not fit
  if (!stream_) throw error(Exit::io, "cannot write {}: {}", path_.target().string(), reason());
  path_.commit();
}

void write_file(const fs::path& target, std::string_view bytes) {
  AtomicFile file(target);
  file.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.commit();
}

std::string read_file(const fs::path& file, std::size_t limit) {
  std::error_code ignored;
  if (fs::is_directory(file, ignored))
    throw error(Exit::io, "cannot read {}: it is a folder; name a file in it", file.string());
  if (fs::is_fifo(file, ignored) || fs::is_socket(file, ignored))  // opening would wait for its writer
    throw error(Exit::io, "cannot read {}: it is a pipe; name a file", file.string());
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw error(Exit::io, "cannot read {}: {}", file.string(), reason());
  std::string bytes;
  char block[1 << 16];
  while (stream.read(block, sizeof block), stream.gcount() > 0) {
    bytes.append(block, static_cast<std::size_t>(stream.gcount()));
    if (bytes.size() > limit)
      throw error(Exit::io, "cannot read {}: it is longer than {} bytes", file.string(), limit);
  }
  if (stream.bad()) throw error(Exit::io, "cannot read {}: {}", file.string(), reason());
  return bytes;
}

}  // namespace weft
