// Files are written whole or not at all, and every failure is an Error with the exit code for input and
// output.
#include "core/file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <functional>

#include "core/error.h"

namespace weft {
namespace {
namespace fs = std::filesystem;

class Files : public ::testing::Test {
 protected:
  Files() : folder_(fs::temp_directory_path() / ("weft-file-test-" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~Files() override { fs::remove_all(folder_); }

  std::size_t entry_count() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  fs::path folder_;
};

Exit code_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const Error& failure) {
    return failure.code();
  }
  return Exit::ok;
}

TEST_F(Files, ReadsBackWhatWasWritten) {
  const std::string bytes("a\0b\r\n\xff", 6);
  write_file(folder_ / "x.bin", bytes);
  EXPECT_EQ(read_file(folder_ / "x.bin"), bytes);
  EXPECT_EQ(entry_count(), 1u);  // no temporary is left
}

TEST_F(Files, KeepsTheOldFileUntilTheNewOneIsComplete) {
  write_file(folder_ / "x.csv", "old");
  {
    AtomicFile unfinished(folder_ / "x.csv");
    unfinished.stream() << "half of the new";
  }
  EXPECT_EQ(read_file(folder_ / "x.csv"), "old");
  EXPECT_EQ(entry_count(), 1u);
}

TEST_F(Files, TemporaryKeepsTheExtensionAndTheFolder) {
  const AtomicPath video(folder_ / "clip.mp4");
  EXPECT_EQ(video.temporary().extension(), ".mp4");  // ffmpeg chooses the format by it
  EXPECT_EQ(fs::canonical(video.temporary().parent_path()), fs::canonical(folder_));
  EXPECT_NE(video.temporary(), AtomicPath(folder_ / "clip.mp4").temporary());
}

TEST_F(Files, WritesThroughALink) {
  write_file(folder_ / "real.txt", "old");
  fs::create_symlink(folder_ / "real.txt", folder_ / "link.txt");
  write_file(folder_ / "link.txt", "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.txt"));
  EXPECT_EQ(read_file(folder_ / "real.txt"), "new");
}

TEST_F(Files, WritesWhereALinkPointsThoughNothingIsThereYet) {
  fs::create_symlink("real.txt", folder_ / "link.txt");
  write_file(folder_ / "link.txt", "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.txt"));
  EXPECT_EQ(read_file(folder_ / "real.txt"), "new");
  EXPECT_EQ(entry_count(), 2u);
  fs::create_symlink("no/x.txt", folder_ / "astray.txt");
  EXPECT_EQ(code_of([&] { write_file(folder_ / "astray.txt", "a"); }), Exit::io);
  fs::create_symlink("circle.txt", folder_ / "circle.txt");
  EXPECT_EQ(code_of([&] { write_file(folder_ / "circle.txt", "a"); }), Exit::io);
  EXPECT_TRUE(fs::is_symlink(fs::symlink_status(folder_ / "circle.txt")));
}

// Opening a pipe waits until somebody opens its other end: it must not come to that.
TEST_F(Files, RefusesAPipeInsteadOfWaiting) {
  const fs::path pipe = folder_ / "pipe.csv";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(code_of([&] { write_file(pipe, "a"); }), Exit::io);
  EXPECT_EQ(code_of([&] { read_file(pipe); }), Exit::io);
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST_F(Files, NeverReplacesADevice) {
  write_file("/dev/null", "gone");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(Files, RefusesWithTheExitCodeOfInputAndOutput) {
  EXPECT_EQ(code_of([&] { write_file(folder_ / "no" / "x.csv", "a"); }), Exit::io);
  EXPECT_EQ(code_of([&] { write_file(folder_, "a"); }), Exit::io);
  EXPECT_EQ(code_of([&] { write_file("", "a"); }), Exit::io);
  EXPECT_EQ(code_of([&] { read_file(folder_ / "none"); }), Exit::io);
  EXPECT_EQ(code_of([&] { read_file(folder_); }), Exit::io);
  EXPECT_EQ(code_of([&] { read_file("/dev/zero", 1000); }), Exit::io);
}

TEST_F(Files, SeesAFullDisk) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_EQ(code_of([&] { write_file("/dev/full", std::string(100000, 'x')); }), Exit::io);
}

}  // namespace
}  // namespace weft
