// The rows. A row without text of its own shares the line of the row before it.
#include "viewer/keys.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <array>

namespace weft {
namespace {

constexpr std::array kRows = {
    KeyRow{Command::scene, GLFW_KEY_1, 1, false, false, "1 - 6", "open a scene", "Scene"},
    KeyRow{Command::scene, GLFW_KEY_2, 2, false, false, "", "", "Scene"},
    KeyRow{Command::scene, GLFW_KEY_3, 3, false, false, "", "", "Scene"},
    KeyRow{Command::scene, GLFW_KEY_4, 4, false, false, "", "", "Scene"},
    KeyRow{Command::scene, GLFW_KEY_5, 5, false, false, "", "", "Scene"},
    KeyRow{Command::scene, GLFW_KEY_6, 6, false, false, "", "", "Scene"},
    KeyRow{Command::reset, GLFW_KEY_R, 0, false, false, "R", "start the scene again", "Scene"},
    KeyRow{Command::reload, GLFW_KEY_F5, 0, false, false, "F5", "read the scene file and the shaders again",
           "Scene"},
    KeyRow{Command::pause, GLFW_KEY_SPACE, 0, false, false, "Space", "pause and go on", "Time"},
    KeyRow{Command::step, GLFW_KEY_PERIOD, 0, false, true, ". or Right", "one frame, while paused", "Time"},
    KeyRow{Command::step, GLFW_KEY_RIGHT, 0, false, true, "", "", "Time"},
    KeyRow{Command::slower, GLFW_KEY_MINUS, 0, false, false, "- and =", "slower, faster; the time step stays",
           "Time"},
    KeyRow{Command::faster, GLFW_KEY_EQUAL, 0, false, false, "", "", "Time"},
    KeyRow{Command::pointer, 0, 0, false, false, "left drag", "on the cloth pulls it, elsewhere orbits",
           "Mouse"},
    KeyRow{Command::pointer, 0, 0, false, false, "middle drag", "pans", "Mouse"},
    KeyRow{Command::pointer, 0, 0, false, false, "wheel", "zooms", "Mouse"},
    KeyRow{Command::pin, GLFW_KEY_P, 0, false, false, "P or double-click",
           "pins or unpins the cloth under the pointer", "Mouse"},
    KeyRow{Command::move_forward, GLFW_KEY_W, 0, true, false, "W A S D", "move: forward, left, back, right",
           "Camera"},
    KeyRow{Command::move_left, GLFW_KEY_A, 0, true, false, "", "", "Camera"},
    KeyRow{Command::move_back, GLFW_KEY_S, 0, true, false, "", "", "Camera"},
    KeyRow{Command::move_right, GLFW_KEY_D, 0, true, false, "", "", "Camera"},
    KeyRow{Command::turn_left, GLFW_KEY_LEFT, 0, true, false, "arrows", "turn", "Camera"},
    KeyRow{Command::turn_right, GLFW_KEY_RIGHT, 0, true, false, "", "", "Camera"},
    KeyRow{Command::turn_up, GLFW_KEY_UP, 0, true, false, "", "", "Camera"},
    KeyRow{Command::turn_down, GLFW_KEY_DOWN, 0, true, false, "", "", "Camera"},
    KeyRow{Command::home, GLFW_KEY_HOME, 0, false, false, "Home", "back to where the camera began", "Camera"},
    KeyRow{Command::wireframe, GLFW_KEY_M, 0, false, false, "M", "wireframe", "Picture"},
    KeyRow{Command::smooth, GLFW_KEY_N, 0, false, false, "N", "smooth or flat; flat draws half the triangles",
           "Picture"},
    KeyRow{Command::heat_map, GLFW_KEY_H, 0, false, false, "H", "colour by strain", "Picture"},
    KeyRow{Command::screenshot, GLFW_KEY_F12, 0, false, false, "F12", "save a picture (PNG)", "Picture"},
    KeyRow{Command::video, GLFW_KEY_V, 0, false, false, "V", "record a video (MP4), stop it", "Picture"},
    KeyRow{Command::help, GLFW_KEY_F1, 0, false, false, "F1", "this help", "Window"},
    KeyRow{Command::overlay, GLFW_KEY_F2, 0, false, false, "F2", "numbers in the corner", "Window"},
    KeyRow{Command::pass_timings, GLFW_KEY_F3, 0, false, false, "F3", "milliseconds a pass", "Window"},
    KeyRow{Command::accuracy, GLFW_KEY_F4, 0, false, false, "F4", "what accuracy costs", "Window"},
    KeyRow{Command::panels, GLFW_KEY_TAB, 0, false, false, "Tab", "hide or show the panels", "Window"},
    KeyRow{Command::full_screen, GLFW_KEY_F11, 0, false, false, "F11", "full screen", "Window"},
    KeyRow{Command::cancel, GLFW_KEY_ESCAPE, 0, false, false, "Esc",
           "cancel; with nothing to cancel, ask to quit", "Window"},
};

}  // namespace

std::span<const KeyRow> key_rows() { return kRows; }

const KeyRow* find_key(int key, bool paused) {
  const KeyRow* found = nullptr;
  for (const KeyRow& row : kRows) {
    if (row.key != key || key == 0) continue;
    if (row.only_paused && !paused) continue;
    if (found == nullptr || row.only_paused) found = &row;
  }
  return found;
}

}  // namespace weft
