// The one table of keys and mouse gestures: handling, the help window and docs/viewer.md follow from it.
#pragma once
#include <span>
#include <string_view>

namespace weft {

enum class Command {
  scene,  ///< the row's `argument` is its number
  pause,
  step,
  reset,
  slower,
  faster,
  move_forward,
  move_back,
  move_left,
  move_right,
  turn_left,
  turn_right,
  turn_up,
  turn_down,
  home,
  pin,
  help,
  overlay,
  pass_timings,
  accuracy,
  reload,
  full_screen,
  screenshot,
  video,
  wireframe,
  smooth,
  heat_map,
  panels,
  cancel,
  pointer,  ///< a gesture of the mouse: told in the help, handled in hand.cpp
};

struct KeyRow {
  Command command;
  int key;  ///< GLFW_KEY_*; 0 for gestures
  int argument;
  bool held;              ///< acts for as long as it is down, not once a press
  bool only_paused;       ///< acts only while paused; another row may have the same key otherwise
  std::string_view keys;  ///< as people read it
  std::string_view about;
  std::string_view group;  ///< heading in the help; empty: told together with the row above
};

std::span<const KeyRow> key_rows();

/// The row a key press means now, or nullptr.
const KeyRow* find_key(int key, bool paused);

}  // namespace weft
