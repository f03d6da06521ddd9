// How the scene is looked at, which panels are open, and what was said last. Plain data that keys, mouse
// and panels share.
#pragma once
#include <chrono>
#include <optional>
#include <string>

#include "render/renderer.h"
#include "scene/scene.h"
#include "viewer/painter.h"

namespace weft {

struct Message {
  std::string text;
  bool is_error = false;
  std::chrono::steady_clock::time_point until{};  ///< errors stay until Esc
};

struct ViewState {
  Camera camera, home;
  Look look;
  SceneArea area;
  bool panels = true, overlay = true, timings = false, accuracy = false, help = false, ask_quit = false;
  bool screenshot = false;  ///< wanted of the next picture
  bool filming = false;
  std::optional<Message> message;

  void say(std::string text, double for_s = 4.0) {
    const auto duration =
        std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(for_s));
    message = Message{std::move(text), false, std::chrono::steady_clock::now() + duration};
  }
  void complain(std::string text) { message = Message{std::move(text), true, {}}; }
};

}  // namespace weft
