// Files read whole and written whole: a result appears under its name only when it is complete, so an
// interrupted or failed run never leaves half a file behind.
#pragma once
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace weft {

/// A name to write to first, beside the target and with its extension, so that other programs may write it.
/// `commit` renames it to the target; without it the destructor removes it. A character device
/// (/dev/null) is written directly; a link keeps pointing where it did, also to a file not there yet.
class AtomicPath {
 public:
  /// @throws Error(Exit::io) when the folder does not exist or the target is a folder, a pipe or
  /// a circle of links
  explicit AtomicPath(const std::filesystem::path& target);
  ~AtomicPath();
  AtomicPath(const AtomicPath&) = delete;
  AtomicPath& operator=(const AtomicPath&) = delete;

  const std::filesystem::path& temporary() const { return temporary_; }
  const std::filesystem::path& target() const { return target_; }
  /// @throws Error(Exit::io) when the rename fails
  void commit();

 private:
  std::filesystem::path target_, temporary_;
  bool committed_ = false;
};

/// An output stream onto an AtomicPath: write to `stream()`, then `commit()`.
class AtomicFile {
 public:
  /// @throws Error(Exit::io) when the file cannot be created
  explicit AtomicFile(const std::filesystem::path& target);
  std::ostream& stream() { return stream_; }
  /// @throws Error(Exit::io) when anything written did not reach the file (a full disk) or the rename fails
  void commit();

 private:
  AtomicPath path_;
  std::ofstream stream_;
};

/// Writes `bytes` to `target` whole or not at all.
/// @throws Error(Exit::io)
void write_file(const std::filesystem::path& target, std::string_view bytes);

/// The whole file as bytes, at most `limit` of them.
/// @throws Error(Exit::io) when it cannot be read, is a folder or a pipe, or is longer than `limit`
std::string read_file(const std::filesystem::path& file, std::size_t limit = std::size_t(1) << 30);

}  // namespace weft
