// Xvfb, the program, xdotool and the log.
#include "viewer/window_driver.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace weft::test {
namespace {

using Clock = std::chrono::steady_clock;

void rest() { std::this_thread::sleep_for(std::chrono::milliseconds(20)); }

bool passed(Clock::time_point start, double timeout_s) {
  return std::chrono::duration<double>(Clock::now() - start).count() > timeout_s;
}

bool there(const char* program) {
  return std::system((std::string("command -v ") + program + " >/dev/null").c_str()) == 0;
}

/// Starts a program with extra environment, its output in a file. Returns its process id.
pid_t start(const std::vector<std::string>& words, const std::vector<std::string>& environment,
            const std::filesystem::path& output, int keep_open = -1) {
  const pid_t child = fork();
  if (child != 0) return child;
  const int file = open(output.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0644);
  dup2(file, STDOUT_FILENO);
  dup2(file, STDERR_FILENO);
  if (keep_open >= 0) fcntl(keep_open, F_SETFD, 0);
  for (const std::string& entry : environment) putenv(const_cast<char*>(entry.c_str()));
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  execvp(arguments[0], arguments.data());
  _exit(127);
}

}  // namespace

int run_command(const std::string& command, std::string& output) {
  output.clear();
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return -1;
  std::array<char, 4096> part{};
  while (const std::size_t count = fread(part.data(), 1, part.size(), pipe))
    output.append(part.data(), count);
  const int status = pclose(pipe);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string window_tests_impossible() {
  for (const char* program : {"Xvfb", "xdotool"})
    if (!there(program)) return std::string(program) + " is not installed";
  return "";
}

VirtualDisplay::VirtualDisplay() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe for Xvfb");
  const std::filesystem::path log = std::filesystem::temp_directory_path() / "weft-xvfb.log";
  process_ = start(
      {"Xvfb", "-displayfd", std::to_string(ends[1]), "-screen", "0", "1600x1000x24", "-nolisten", "tcp"}, {},
      log, ends[1]);
  close(ends[1]);
  std::string number;
  for (char letter = 0; read(ends[0], &letter, 1) == 1 && letter != '\n';) number += letter;
  close(ends[0]);
  if (number.empty()) throw std::runtime_error("Xvfb did not start; see " + log.string());
  name_ = ":" + number;
}

VirtualDisplay::~VirtualDisplay() {
  kill(process_, SIGTERM);
  waitpid(process_, nullptr, 0);
}

WindowUnderTest::WindowUnderTest(const std::vector<std::string>& arguments) {
  static int count = 0;
  folder_ = std::filesystem::temp_directory_path() /
            ("weft-window-" + std::to_string(getpid()) + "-" + std::to_string(++count));
  std::filesystem::create_directories(folder_);
  log_ = folder_ / "log";
  // From the folder, so that pictures and films land in it. `exec` keeps the process id.
  std::string command = "cd " + folder_.string() + " && exec " WEFT_PROGRAM " view --validation";
  for (const std::string& argument : arguments) command += " " + argument;
  process_ = start({"sh", "-c", command}, {"WEFT_VIEWER_LOG=" + log_.string(), "WEFT_REQUIRE_GPU="},
                   folder_ / "output");
  if (!wait_pictures(3, 60.0)) throw std::runtime_error("the window shows no picture: " + output());
  std::string found;
  run_command("xdotool search --onlyvisible --pid " + std::to_string(process_) + " --name Weft", found);
  window_ = found.substr(0, found.find('\n'));
  act("windowfocus --sync $W");  // no window manager gives the focus here
}

WindowUnderTest::~WindowUnderTest() {
  if (process_ > 0) {
    kill(process_, SIGTERM);
    waitpid(process_, nullptr, 0);
  }
  std::filesystem::remove_all(folder_);
}

std::string WindowUnderTest::output() const {
  std::ifstream file(folder_ / "output");
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<std::string> WindowUnderTest::lines(const std::string& prefix) const {
  std::ifstream file(log_);
  std::vector<std::string> found;
  for (std::string line; std::getline(file, line);)
    if (line.starts_with(prefix) && !file.eof()) found.push_back(line);  // the last may be half written
  return found;
}

WindowState WindowUnderTest::state() const {
  const std::vector<std::string> all = lines("state ");
  WindowState state;
  if (all.empty()) return state;
  std::stringstream words(all.back());
  for (std::string word; words >> word;)
    if (const std::size_t equals = word.find('='); equals != std::string::npos)
      state[word.substr(0, equals)] = word.substr(equals + 1);
  return state;
}

std::string WindowUnderTest::value(const std::string& key) const {
  const WindowState now = state();
  const auto found = now.find(key);
  return found != now.end() ? found->second : "";
}

double WindowUnderTest::number(const std::string& key) const {
  const std::string text = value(key);
  return text.empty() ? -1.0 : std::stod(text);
}

bool WindowUnderTest::wait_for(const std::string& key, const std::string& wanted, double timeout_s) const {
  for (const Clock::time_point begun = Clock::now(); !passed(begun, timeout_s); rest())
    if (value(key) == wanted) return true;
  return false;
}

bool WindowUnderTest::wait_pictures(int count, double timeout_s) const {
  const double before = std::max(0.0, number("pictures"));
  for (const Clock::time_point begun = Clock::now(); !passed(begun, timeout_s); rest())
    if (number("pictures") >= before + count) return true;
  return false;
}

std::vector<std::string> WindowUnderTest::events(const std::string& text) const {
  return lines("event " + text);
}

double WindowUnderTest::largest(const std::string& key) const {
  double most = 0.0;
  for (const std::string& line : lines("state ")) {
    const std::size_t at = line.find(" " + key + "=");
    if (at != std::string::npos) most = std::max(most, std::stod(line.substr(at + key.size() + 2)));
  }
  return most;
}

void WindowUnderTest::act(const std::string& words) const {
  std::string output;
  const int code = run_command("W=" + window_ + "; xdotool " + words, output);
  if (code != 0) throw std::runtime_error("xdotool " + words + ": " + output);
}

bool WindowUnderTest::say_minimised(bool minimised) const {
  // Loaded here, so that the build needs no headers of X11.
  void* x11 = dlopen("libX11.so.6", RTLD_NOW | RTLD_LOCAL);
  if (x11 == nullptr) return false;
  const auto open_display = reinterpret_cast<void* (*)(const char*)>(dlsym(x11, "XOpenDisplay"));
  const auto intern = reinterpret_cast<unsigned long (*)(void*, const char*, int)>(dlsym(x11, "XInternAtom"));
  const auto change = reinterpret_cast<int (*)(void*, unsigned long, unsigned long, unsigned long, int, int,
                                               const void*, int)>(dlsym(x11, "XChangeProperty"));
  const auto close_display = reinterpret_cast<int (*)(void*)>(dlsym(x11, "XCloseDisplay"));
  if (open_display == nullptr || intern == nullptr || change == nullptr || close_display == nullptr)
    return false;
  void* display = open_display(nullptr);
  if (display == nullptr) return false;
  const unsigned long name = intern(display, "WM_STATE", 0);
  const std::array<long, 2> state{minimised ? 3 : 1, 0};  // IconicState or NormalState, no icon window
  change(display, std::stoul(window_), name, name, 32, 0, state.data(), 2);
  close_display(display);  // sends what is pending
  return true;
}

int WindowUnderTest::exit_code() {
  for (const Clock::time_point begun = Clock::now(); !passed(begun, 10.0); rest()) {
    int status = 0;
    if (waitpid(process_, &status, WNOHANG) != process_) continue;
    process_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  return -1;
}

}  // namespace weft::test
