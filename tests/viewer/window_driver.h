// A real window under a virtual display of its own, with real keys and mouse, watched through its log.
#pragma once
#include <sys/types.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace weft::test {

/// The latest state line of the viewer's log, by key.
using WindowState = std::map<std::string, std::string>;

/// Why windows cannot be tested here; empty when they can.
std::string window_tests_impossible();

/// One Xvfb on a free display for the whole program.
class VirtualDisplay {
 public:
  VirtualDisplay();
  ~VirtualDisplay();
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;
  const std::string& name() const { return name_; }  ///< ":99"

 private:
  pid_t process_ = -1;
  std::string name_;
};

class WindowUnderTest {
 public:
  /// Starts `weft view ARGUMENTS` with validation and waits for its first pictures.
  explicit WindowUnderTest(const std::vector<std::string>& arguments);
  /// Closes the window; kills the program when it does not go.
  ~WindowUnderTest();
  WindowUnderTest(const WindowUnderTest&) = delete;
  WindowUnderTest& operator=(const WindowUnderTest&) = delete;

  WindowState state() const;
  std::string value(const std::string& key) const;
  double number(const std::string& key) const;
  /// Waits until the latest state has key=value.
  bool wait_for(const std::string& key, const std::string& value, double timeout_s = 15.0) const;
  /// Waits until so many more pictures were shown.
  bool wait_pictures(int count, double timeout_s = 30.0) const;
  /// Lines of the log that begin with "event TEXT".
  std::vector<std::string> events(const std::string& text) const;
  /// The largest value of a number in all state lines so far.
  double largest(const std::string& key) const;

  void key(const std::string& name) const { act("key " + name); }
  /// xdotool's own words: "mousemove --window $W 10 20 click 1"; $W is the window.
  void act(const std::string& words) const;
  /// Says that the window is minimised, or normal again, as a window manager does (none runs here): the
  /// property WM_STATE of ICCCM 4.1.3.1. Returns false where libX11 cannot be loaded.
  bool say_minimised(bool minimised) const;
  std::filesystem::path folder() const { return folder_; }
  std::string output() const;  ///< what the program has written so far, validation messages among it
  /// Waits for the program to end and returns its exit code; −1 when it does not within 10 s.
  int exit_code();

 private:
  std::vector<std::string> lines(const std::string& prefix) const;

  std::filesystem::path folder_, log_;
  pid_t process_ = -1;
  std::string window_;
};

/// Runs a command to its end. Returns the exit code; `output` gets stdout and stderr together.
int run_command(const std::string& command, std::string& output);

}  // namespace weft::test
