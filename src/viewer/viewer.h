// The window: a running scene drawn from the buffers the compute passes write, with keys, mouse and
// sliders. docs/viewer.md says what people can do in it.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "scene/reader.h"

namespace weft {

struct ViewerOptions {
  std::string scene = "1";   ///< number, name in assets/scenes, or path
  SceneOverrides overrides;  ///< changes on top of every scene opened, `--set` and its shorthands
  std::string device;        ///< part of a name, index or UUID, or native; empty: the best
                             ///< there is, and native where that is a software one
  std::string kernel;  ///< of the pass integrate, one of kernel_names(); empty: auto; "auto" has a software
                       ///< device try them too
  bool validation = false;     ///< core and synchronization validation; messages are counted and shown
  bool force_staging = false;  ///< pretend no device memory is host visible
  std::filesystem::path
      shader_dir;  ///< GLSL sources to compile instead of the embedded modules; may be empty
  std::uint32_t width = 1280, height = 720;  ///< of the window, in screen coordinates
  std::string present_mode;   ///< "fifo", "mailbox" or "immediate"; empty: fifo, which every device has
  std::uint32_t samples = 0;  ///< MSAA samples; 0: 4, and 1 on a software device
  double quit_after_s = 0.0;  ///< wall time after which the window closes by itself; 0: never
  std::uint64_t quit_after_frames = 0;      ///< pictures shown after which it closes; 0: never
  std::filesystem::path screenshot;         ///< written just before the window closes by itself; empty: none
  std::filesystem::path capture_dir = ".";  ///< where F12 and V write their files
  std::filesystem::path log;                ///< state lines for tests; empty: $WEFT_VIEWER_LOG, else none
};

/// Opens the window and returns when it is closed, with the program's exit code.
/// @throws Error(Exit::no_device) without a display (it says to use `weft render`), without a device that can
///         show a window, or with only a software device while WEFT_REQUIRE_GPU=1
/// @throws Error(Exit::usage) when the scene cannot be opened, as load_scene does
int run_viewer(const ViewerOptions& options);

/// Whether a window can be opened here at all: a display that answers. Opens none.
bool display_available();

}  // namespace weft
