// A GLFW window and the input it collected since last asked, in order. GLFW's errors become ours.
#pragma once
#include <vulkan/vulkan.h>

#include <cstdint>
#include <string>
#include <vector>

struct GLFWwindow;

namespace weft {

/// What a person did. Positions are in window coordinates [screen units], y down.
struct InputEvent {
  enum class Kind { key, button, move, scroll };
  Kind kind = Kind::key;
  int code = 0;           ///< GLFW key or mouse button
  bool pressed = false;   ///< of a key or button; releases of keys are not reported
  bool repeated = false;  ///< a key held down
  int mods = 0;           ///< GLFW_MOD_*
  double x = 0, y = 0;    ///< pointer, or scroll offsets
};

struct WindowSize {
  std::uint32_t width = 0, height = 0;
  bool operator==(const WindowSize&) const = default;
  bool empty() const { return width == 0 || height == 0; }
};

class Window {
 public:
  /// @throws Error(Exit::no_device) when there is no display, or it can show no Vulkan picture
  Window(const std::string& title, WindowSize size);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  GLFWwindow* handle() const { return window_; }
  /// Instance extensions that a surface needs.
  static std::vector<const char*> instance_extensions();
  /// The caller destroys it, before the instance.
  VkSurfaceKHR create_surface(VkInstance) const;

  /// Lets the system speak; waits up to `timeout_s` for something to happen, not at all when 0.
  void poll(double timeout_s);
  std::vector<InputEvent> take_events();
  bool has_events() const { return !events_.empty(); }  ///< since they were taken
  bool should_close() const;
  void request_close();
  WindowSize framebuffer() const;  ///< pixels; empty while minimised
  WindowSize size() const;         ///< screen units
  bool minimised() const;
  bool held(int key) const;
  void set_title(const std::string&);
  void toggle_full_screen();

 private:
  void install_callbacks();

  GLFWwindow* window_ = nullptr;
  std::vector<InputEvent> events_;
  double pointer_x_ = 0.0, pointer_y_ = 0.0;
  int restore_x_ = 0, restore_y_ = 0, restore_width_ = 0, restore_height_ = 0;
};

}  // namespace weft
