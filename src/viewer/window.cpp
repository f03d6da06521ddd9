// GLFW: start, window, callbacks into one ordered list of events.
#include "viewer/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <spdlog/spdlog.h>

#include <cstdlib>
#include <utility>

#include "core/error.h"
#include "gpu/device.h"
#include "viewer/viewer.h"

namespace weft {
namespace {

std::string last_glfw_error() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text != nullptr ? text : "no reason given";
}

Error no_display(const std::string& reason) {
  const char* display = std::getenv("DISPLAY");
  const char* wayland = std::getenv("WAYLAND_DISPLAY");
  return error(
      Exit::no_device,
      "no display to open a window on (DISPLAY={}, WAYLAND_DISPLAY={}: {}); start weft from a desktop, or "
      "render without one: weft render 1 --out scene1.mp4",
      display != nullptr ? display : "unset", wayland != nullptr ? wayland : "unset", reason);
}

Window* owner(GLFWwindow* window) { return static_cast<Window*>(glfwGetWindowUserPointer(window)); }

}  // namespace

bool display_available() {
  if (glfwInit() != GLFW_TRUE) return false;
  glfwTerminate();
  return true;
}

Window::Window(const std::string& title, WindowSize size) {
  glfwSetErrorCallback(nullptr);
  if (glfwInit() != GLFW_TRUE) throw no_display(last_glfw_error());
  glfwSetErrorCallback(
      [](int code, const char* text) { spdlog::error("window system ({:#x}): {}", code, text); });
  if (glfwVulkanSupported() != GLFW_TRUE) {
    glfwTerminate();
    throw error(
        Exit::no_device,
        "this display can show no Vulkan picture (no loader, or no surface extension); install the Vulkan "
        "driver of your device, on Debian mesa-vulkan-drivers");
  }
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  window_ = glfwCreateWindow(static_cast<int>(size.width), static_cast<int>(size.height), title.c_str(),
                             nullptr, nullptr);
  if (window_ == nullptr) {
    const std::string reason = last_glfw_error();
    glfwTerminate();
    throw error(Exit::no_device, "no window of {} × {} could be opened: {}", size.width, size.height, reason);
  }
  glfwSetWindowUserPointer(window_, this);
  glfwSetWindowSizeLimits(window_, 320, 240, GLFW_DONT_CARE, GLFW_DONT_CARE);
  install_callbacks();
}

Window::~Window() {
  glfwDestroyWindow(window_);
  glfwTerminate();
  glfwSetErrorCallback(nullptr);
}

void Window::install_callbacks() {
  glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int mods) {
    if (action == GLFW_RELEASE) return;
    owner(window)->events_.push_back({.kind = InputEvent::Kind::key,
                                      .code = key,
                                      .pressed = true,
                                      .repeated = action == GLFW_REPEAT,
                                      .mods = mods});
  });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* window, int button, int action, int mods) {
    // The place of the latest move, in order; the pointer itself may be elsewhere by now.
    Window& self = *owner(window);
    self.events_.push_back({.kind = InputEvent::Kind::button,
                            .code = button,
                            .pressed = action == GLFW_PRESS,
                            .mods = mods,
                            .x = self.pointer_x_,
                            .y = self.pointer_y_});
  });
  glfwSetCursorPosCallback(window_, [](GLFWwindow* window, double x, double y) {
    Window& self = *owner(window);
    self.pointer_x_ = x;
    self.pointer_y_ = y;
    self.events_.push_back({.kind = InputEvent::Kind::move, .x = x, .y = y});
  });
  glfwSetScrollCallback(window_, [](GLFWwindow* window, double x, double y) {
    owner(window)->events_.push_back({.kind = InputEvent::Kind::scroll, .x = x, .y = y});
  });
}

std::vector<const char*> Window::instance_extensions() {
  std::uint32_t count = 0;
  const char** names = glfwGetRequiredInstanceExtensions(&count);
  return names != nullptr ? std::vector<const char*>(names, names + count) : std::vector<const char*>{};
}

VkSurfaceKHR Window::create_surface(VkInstance instance) const {
  VkSurfaceKHR surface = VK_NULL_HANDLE;
  gpu::check(glfwCreateWindowSurface(instance, window_, nullptr, &surface), "a surface for the window");
  return surface;
}

void Window::poll(double timeout_s) {
  if (timeout_s > 0.0) {
    glfwWaitEventsTimeout(timeout_s);
  } else {
    glfwPollEvents();
  }
}

std::vector<InputEvent> Window::take_events() { return std::exchange(events_, {}); }

bool Window::should_close() const { return glfwWindowShouldClose(window_) == GLFW_TRUE; }

void Window::request_close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }

WindowSize Window::framebuffer() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

WindowSize Window::size() const {
  int width = 0, height = 0;
  glfwGetWindowSize(window_, &width, &height);
  return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

bool Window::minimised() const {
  return glfwGetWindowAttrib(window_, GLFW_ICONIFIED) == GLFW_TRUE || framebuffer().empty();
}

bool Window::held(int key) const { return glfwGetKey(window_, key) == GLFW_PRESS; }

void Window::set_title(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

void Window::toggle_full_screen() {
  if (glfwGetWindowMonitor(window_) != nullptr) {
    glfwSetWindowMonitor(window_, nullptr, restore_x_, restore_y_, restore_width_, restore_height_,
                         GLFW_DONT_CARE);
    return;
  }
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  const GLFWvidmode* mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
  if (mode == nullptr) return;
  glfwGetWindowPos(window_, &restore_x_, &restore_y_);
  glfwGetWindowSize(window_, &restore_width_, &restore_height_);
  glfwSetWindowMonitor(window_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

}  // namespace weft
