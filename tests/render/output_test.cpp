// Files of pictures: whole or not at all, and every failure told with its cure and exit code 6.
#include "render/output.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>

#include "core/error.h"
#include "gpu_fixture.h"
#include "render/image.h"
#include "render/video.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;

/// A folder of the test's own, removed afterwards.
class OutputTest : public ::testing::Test {
 protected:
  OutputTest() {
    std::string pattern = (fs::temp_directory_path() / "weft-output-XXXXXX").string();
    folder = mkdtemp(pattern.data());
  }
  ~OutputTest() override { fs::remove_all(folder); }

  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }
  /// A program called ffmpeg in a folder of its own, and that folder.
  fs::path fake_ffmpeg(const std::string& script) const {
    const fs::path bin = folder / "bin";
    fs::create_directory(bin);
    std::ofstream(bin / "ffmpeg") << "#!/bin/sh\n" << script << "\n";
    fs::permissions(bin / "ffmpeg", fs::perms::owner_all);
    return bin;
  }

  fs::path folder;
};

Picture gradient(std::uint32_t width, std::uint32_t height, std::uint8_t blue = 7) {
  Picture picture{width, height, {}};
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x)
      for (const std::uint32_t value : {x * 255 / width, y * 255 / height, std::uint32_t{blue}, 255u})
        picture.rgba.push_back(static_cast<std::uint8_t>(value));
  return picture;
}

/// What `action` throws: its code and words.
struct Failure {
  Exit code = Exit::ok;
  std::string text;
  bool says(const std::string& words) const { return text.find(words) != std::string::npos; }
};
template <class Action>
Failure failure_of(Action&& action) {
  try {
    action();
  } catch (const Error& thrown) {
    return {thrown.code(), thrown.what()};
  }
  return {};
}

bool ffmpeg_there() { return std::system("ffmpeg -version > /dev/null 2>&1") == 0; }

std::string answer(const std::string& command) {
  std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string text;
  std::array<char, 256> part;
  while (pipe && fgets(part.data(), part.size(), pipe.get()) != nullptr) text += part.data();
  return text;
}

TEST_F(OutputTest, PngComesBackAsItWas) {
  const Picture picture = gradient(37, 21);
  write_png(folder / "a.png", picture);
  const Picture read = read_png(folder / "a.png");
  EXPECT_EQ(read.width, 37u);
  EXPECT_EQ(read.height, 21u);
  EXPECT_EQ(read.rgba, picture.rgba);
  EXPECT_EQ(files(), 1u) << "no temporary file stays";
}

TEST_F(OutputTest, PngFailuresAreInputOutput) {
  const Picture picture = gradient(4, 4);
  EXPECT_EQ(failure_of([&] { write_png(folder / "missing" / "a.png", picture); }).code, Exit::io);
  fs::create_directory(folder / "b.png");
  EXPECT_EQ(failure_of([&] { write_png(folder / "b.png", picture); }).code, Exit::io);
  EXPECT_EQ(failure_of([&] { write_png("/dev/full", picture); }).code, Exit::io);
  std::ofstream(folder / "no.png") << "not a picture";
  const Failure unreadable = failure_of([&] { read_png(folder / "no.png"); });
  EXPECT_EQ(unreadable.code, Exit::io);
  EXPECT_TRUE(unreadable.says("no.png"));
  if (geteuid() == 0) return;  // root writes everywhere
  fs::create_directory(folder / "locked");
  fs::permissions(folder / "locked", fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_EQ(failure_of([&] { write_png(folder / "locked" / "a.png", picture); }).code, Exit::io);
}

TEST_F(OutputTest, NameDecidesTheKind) {
  EXPECT_EQ(output_kind("a.png"), OutputKind::picture);
  EXPECT_EQ(output_kind("a.PNG"), OutputKind::picture);
  EXPECT_EQ(output_kind("d/frame-%04d.png"), OutputKind::sequence);
  EXPECT_EQ(output_kind("d/%d.png"), OutputKind::sequence);
  EXPECT_EQ(output_kind("a.mp4"), OutputKind::video);
  for (const char* wrong : {"a", "a.gif", "", ".mp", "a.png.txt", "%n.png", "a%.png", "a%s.png", "a%4d.png",
                            "a%04d%04d.png", "d-%04d/a.png", "a%0000000009d.png", "a%099999d.png"})
    EXPECT_EQ(failure_of([&] { output_kind(wrong); }).code, Exit::usage) << wrong;
  EXPECT_EQ(sequence_name("d/frame-%04d.png", 7), "d/frame-0007.png");
  EXPECT_EQ(sequence_name("%d.png", 12), "12.png");
  EXPECT_EQ(sequence_name("%02d.png", 1234), "1234.png");
}

TEST_F(OutputTest, SequenceMakesItsFolderAndNumbersFromZero) {
  const auto output = open_output((folder / "x" / "y" / "p-%03d.png").string(), 8, 8, 60.0);
  for (const std::uint8_t blue : std::array<std::uint8_t, 3>{10, 20, 30}) output->add(gradient(8, 8, blue));
  output->finish();
  EXPECT_EQ(read_png(folder / "x" / "y" / "p-000.png").rgba, gradient(8, 8, 10).rgba);
  EXPECT_EQ(read_png(folder / "x" / "y" / "p-002.png").rgba, gradient(8, 8, 30).rgba);
  EXPECT_FALSE(fs::exists(folder / "x" / "y" / "p-003.png"));
}

TEST_F(OutputTest, SinglePictureIsTheLastOne) {
  const auto output = open_output((folder / "a.png").string(), 8, 8, 60.0);
  output->add(gradient(8, 8, 1));
  output->add(gradient(8, 8, 2));
  EXPECT_FALSE(fs::exists(folder / "a.png"));
  output->finish();
  EXPECT_EQ(read_png(folder / "a.png").rgba, gradient(8, 8, 2).rgba);
}

TEST_F(OutputTest, ImpossiblePlacesAreReportedAtOnce) {
  for (const char* name : {"missing/a.png", "missing/a.mp4"})
    EXPECT_EQ(failure_of([&] { open_output((folder / name).string(), 8, 8, 60.0); }).code, Exit::io) << name;
  std::ofstream(folder / "file") << "x";
  EXPECT_EQ(failure_of([&] { open_output((folder / "file" / "%04d.png").string(), 8, 8, 60.0); }).code,
            Exit::io);
}

TEST_F(OutputTest, FilmHasEveryPicture) {
  if (!ffmpeg_there()) GTEST_SKIP() << "ffmpeg is not installed";
  const fs::path film = folder / "a film: 'x'.mp4";
  VideoWriter writer(film, 64, 48, 60.0);
  for (int k = 0; k < 30; ++k) writer.add(gradient(64, 48, static_cast<std::uint8_t>(8 * k)));
  EXPECT_FALSE(fs::exists(film)) << "the name appears only when the film is complete";
  writer.finish();
  fs::rename(film, folder / "film.mp4");
  const std::string probe = answer(
      "ffprobe -v error -count_frames -select_streams v -show_entries "
      "stream=codec_name,width,height,pix_fmt,r_frame_rate,nb_read_frames -of csv=p=0 " +
      (folder / "film.mp4").string());
  EXPECT_EQ(probe, "h264,64,48,yuv420p,60/1,30\n");
  EXPECT_EQ(files(), 1u);
}

TEST_F(OutputTest, UnfinishedFilmLeavesNothing) {
  if (!ffmpeg_there()) GTEST_SKIP() << "ffmpeg is not installed";
  {
    VideoWriter writer(folder / "a.mp4", 64, 48, 60.0);
    writer.add(gradient(64, 48));
  }
  EXPECT_EQ(files(), 0u);
}

TEST_F(OutputTest, OddSizesAreRefusedWithTheNextEvenOne) {
  const Failure odd = failure_of([&] { VideoWriter(folder / "a.mp4", 641, 359, 60.0); });
  EXPECT_EQ(odd.code, Exit::usage);
  EXPECT_TRUE(odd.says("642x360")) << odd.text;
}

TEST_F(OutputTest, MissingFfmpegIsToldWithItsCure) {
  const ScopedEnvironment path("PATH", "/nonexistent");
  const Failure missing = failure_of([&] { VideoWriter(folder / "a.mp4", 64, 48, 60.0); });
  EXPECT_EQ(missing.code, Exit::io);
  EXPECT_TRUE(missing.says("install")) << missing.text;
  EXPECT_TRUE(missing.says("a.mp4")) << missing.text;
  EXPECT_EQ(files(), 0u);
}

TEST_F(OutputTest, FfmpegsWordsAreShownWhenItFails) {
  const ScopedEnvironment path(
      "PATH", fake_ffmpeg("echo 'no such encoder' >&2; cat > /dev/null; exit 3").string() + ":/usr/bin:/bin");
  const Failure failed = failure_of([&] {
    VideoWriter writer(folder / "a.mp4", 64, 48, 60.0);
    writer.add(gradient(64, 48));
    writer.finish();
  });
  EXPECT_EQ(failed.code, Exit::io);
  EXPECT_TRUE(failed.says("no such encoder")) << failed.text;
  EXPECT_EQ(files(), 1u) << "only the fake's own folder";
}

TEST_F(OutputTest, FfmpegDyingEarlyIsNoSilentDeath) {
  // More than any socket holds: writing must meet the closed end, and SIGPIPE must not end this program.
  const ScopedEnvironment path("PATH",
                               fake_ffmpeg("echo 'disk full' >&2; exit 1").string() + ":/usr/bin:/bin");
  const Failure failed = failure_of([&] {
    VideoWriter writer(folder / "a.mp4", 1024, 1024, 60.0);
    for (int k = 0; k < 20; ++k) writer.add(gradient(1024, 1024));
  });
  EXPECT_EQ(failed.code, Exit::io);
  EXPECT_TRUE(failed.says("disk full")) << failed.text;
  EXPECT_EQ(files(), 1u);
}

}  // namespace
}  // namespace weft::test
