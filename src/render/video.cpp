// Runs ffmpeg as a child: pictures go in through a socket, its complaints are kept in memory.
#include "render/video.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/file.h"

extern char** environ;

namespace weft {
namespace {

/// A file descriptor, closed at the end.
class Handle {
 public:
  explicit Handle(int number = -1) : number_(number) {}
  ~Handle() { close(); }
  Handle(Handle&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  int number() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(std::exchange(number_, -1));
  }

 private:
  int number_;
};

std::vector<std::string> arguments(const std::filesystem::path& output, std::uint32_t width,
                                   std::uint32_t height, double fps) {
  // The colours are sRGB; the film is tagged and converted as BT.709, or players would guess.
  return {"ffmpeg",
          "-hide_banner",
          "-nostdin",
          "-loglevel",
          "error",
          "-y",
          "-f",
          "rawvideo",
          "-pixel_format",
          "rgba",
          "-video_size",
          fmt::format("{}x{}", width, height),
          "-framerate",
          fmt::format("{:.9g}", fps),
          "-i",
          "pipe:0",
          "-an",
          "-vf",
          "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p",
          "-c:v",
          "libx264",
          "-preset",
          "veryfast",
          "-crf",
          "17",
          "-colorspace",
          "bt709",
          "-color_primaries",
          "bt709",
          "-color_trc",
          "bt709",
          "-movflags",
          "+faststart",
          "-f",
          "mp4",
          "file:" + output.string()};
}

std::string tail(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  constexpr std::size_t kMost = 2000;
  return text.size() > kMost ? "…" + text.substr(text.size() - kMost) : text;
}

}  // namespace

struct VideoWriter::Impl {
  Impl(const std::filesystem::path& file, std::uint32_t w, std::uint32_t h)
      : output(file), width(w), height(h) {}

  AtomicPath output;
  std::uint32_t width, height;
  Handle pictures, complaints;
  pid_t child = -1;

  void start(double fps);
  void spawn(const std::vector<std::string>& words, int input, int errors);
  int wait_for_child();
  std::string read_complaints() const;
  [[noreturn]] void fail();
};

void VideoWriter::Impl::start(double fps) {
  int ends[2] = {-1, -1};
  // A socket rather than a pipe: writing to one whose reader died can be told not to raise SIGPIPE.
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    throw error(Exit::io, "No socket for ffmpeg: {}", std::strerror(errno));
  pictures = Handle(ends[0]);
  const Handle input(ends[1]);
  complaints = Handle(memfd_create("ffmpeg errors", MFD_CLOEXEC));
  if (complaints.number() < 0)
    throw error(Exit::io, "No memory file for ffmpeg's messages: {}", std::strerror(errno));
  spawn(arguments(output.temporary(), width, height, fps), input.number(), complaints.number());
}

void VideoWriter::Impl::spawn(const std::vector<std::string>& words, int input, int errors) {
  std::vector<char*> argv;
  for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, errors, STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // A process group of its own: Ctrl-C reaches only Weft, which then ends ffmpeg and removes its file.
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  const int answer = posix_spawnp(&child, "ffmpeg", &actions, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (answer == 0) return;
  child = -1;
  throw error(Exit::io,
              "{}: the program ffmpeg could not be started ({}); install it (Debian: apt install ffmpeg), or "
              "write pictures instead: --out DIR/frame-%04d.png",
              output.target().string(), std::strerror(answer));
}

int VideoWriter::Impl::wait_for_child() {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  child = -1;
  return status;
}

std::string VideoWriter::Impl::read_complaints() const {
  const off_t size = lseek(complaints.number(), 0, SEEK_END);
  std::string text(size > 0 ? static_cast<std::size_t>(size) : 0, '\0');
  const ssize_t got = pread(complaints.number(), text.data(), text.size(), 0);
  text.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  return tail(text);
}

void VideoWriter::Impl::fail() {
  pictures.close();
  const int status = wait_for_child();
  const std::string how = WIFSIGNALED(status) ? fmt::format("was ended by signal {}", WTERMSIG(status))
                                              : fmt::format("stopped with exit {}", WEXITSTATUS(status));
  const std::string said = read_complaints();
  throw error(Exit::io, "{}: ffmpeg {}; it says: {}", output.target().string(), how,
              said.empty() ? "nothing" : said);
}

VideoWriter::VideoWriter(const std::filesystem::path& file, std::uint32_t width, std::uint32_t height,
                         double fps) {
  if (width % 2 != 0 || height % 2 != 0)
    throw error(Exit::usage, "{}: the picture is {}x{} pixels; a film's sides must be even (--size {}x{})",
                file.string(), width, height, width + width % 2, height + height % 2);
  WEFT_ASSERT(fps > 0.0);
  impl_ = std::make_unique<Impl>(file, width, height);
  impl_->start(fps);
}

VideoWriter::~VideoWriter() {
  if (!impl_ || impl_->child < 0) return;
  kill(impl_->child, SIGKILL);
  impl_->wait_for_child();
}

void VideoWriter::add(const Picture& picture) {
  WEFT_ASSERT(picture.width == impl_->width && picture.height == impl_->height);
  const std::uint8_t* data = picture.rgba.data();
  std::size_t left = picture.rgba.size();
  while (left > 0) {
    const ssize_t sent = send(impl_->pictures.number(), data, left, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) impl_->fail();
    data += sent;
    left -= static_cast<std::size_t>(sent);
  }
}

void VideoWriter::finish() {
  impl_->pictures.close();
  const int status = impl_->wait_for_child();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    const std::string said = impl_->read_complaints();
    throw error(Exit::io, "{}: ffmpeg failed; it says: {}", impl_->output.target().string(),
                said.empty() ? "nothing" : said);
  }
  impl_->output.commit();
}

}  // namespace weft
