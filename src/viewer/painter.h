// One picture on the window: the scene drawn into an image of its own (smaller than its place on a slow
// device), copied to the window's image, the panels over it; and copies for screenshots and videos.
#pragma once
#include <array>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>

#include "gpu/commands.h"
#include "gpu/recorder.h"
#include "render/picture.h"
#include "render/renderer.h"
#include "viewer/gui.h"
#include "viewer/running_scene.h"
#include "viewer/swapchain.h"

namespace weft {

/// Where the scene lies in the window [pixels].
struct SceneArea {
  std::int32_t x = 0, y = 0;
  std::uint32_t width = 0, height = 0;
  double aspect() const { return static_cast<double>(width) / height; }
};

struct PaintRequest {
  SceneArea area;
  Camera camera;
  Look look;
  bool screenshot = false;  ///< the whole window, panels included
  bool film = false;        ///< the scene alone
};

/// What a request brought back; pictures are there only when asked for.
struct Painted {
  std::optional<Picture> screenshot, film;
};

class Painter {
 public:
  Painter(gpu::Device&, Swapchain&, Gui&, std::uint32_t samples);
  ~Painter();
  Painter(const Painter&) = delete;
  Painter& operator=(const Painter&) = delete;

  /// Draws one picture and shows it, on a software device not before show_drawn() finds it drawn; ends the
  /// panels' frame in any case. Nothing when the window had no image.
  std::optional<Painted> paint(const RunningScene&, WindowSize framebuffer, const PaintRequest&);
  /// Shows the picture that waits for it, if the device has drawn it by now. A software driver lets whoever
  /// shows a picture wait until it is drawn: so nobody has to.
  /// @return  how long it was drawn [s]
  std::optional<double> show_drawn();
  /// Whether the device has drawn all that was asked for, and it is shown: paint() would not wait.
  bool idle() const;
  /// The share of the window's pixels, along each side, that the scene is drawn with.
  double scale() const { return scale_; }
  /// @param automatic  follow the time drawing takes; else `scale` is kept
  void set_scale(double scale, bool automatic);
  /// No larger a scale while it is automatic: what the cores have to spare for drawing.
  void set_scale_most(double scale);
  bool automatic_scale() const { return automatic_; }
  double draw_ms() const { return draw_ms_; }  ///< on the device, smoothed; 0: not known
  VkSampleCountFlagBits samples() const { return samples_; }
  /// Makes every drawing pipeline anew, from the shader sources as they are now.
  /// @throws Error(Exit::usage) when a shader does not compile; the ones before stay in use
  void reload_shaders(const RunningScene&);

 private:
  static constexpr std::uint32_t kFrames = 2;  // pictures in flight
  struct Frame {
    gpu::Commands commands;
    std::unique_ptr<gpu::Timer> timer;
    VkSemaphore acquired = VK_NULL_HANDLE;
    std::uint64_t submitted = 0;  // timeline value, 0: never
  };
  /// A picture that is drawn and not yet shown.
  struct Pending {
    SwapchainImage image;
    std::uint64_t submitted = 0;
    std::chrono::steady_clock::time_point since;
  };
  void show_pending();
  void follow(const RunningScene&);
  void fit_scene_image(const SceneArea& area);
  void record(VkCommandBuffer, const RunningScene&, const PaintRequest&, const SwapchainImage&,
              std::uint32_t slot);
  void copy_to_window(VkCommandBuffer, const SceneArea&, const SwapchainImage&);
  void copy_to_host(VkCommandBuffer, VkImage, VkImageLayout now, VkExtent2D, gpu::Buffer& pixels);
  Picture picture_of(const gpu::Buffer& pixels, VkExtent2D extent) const;
  void adapt_scale();

  gpu::Device& device_;
  Swapchain& swapchain_;
  Gui& gui_;
  VkSampleCountFlagBits samples_;
  std::array<Frame, kFrames> frames_;
  std::unique_ptr<Renderer> renderer_;
  std::optional<Pending> pending_;
  gpu::Image scene_image_;
  gpu::Buffer screenshot_, film_;
  std::uint64_t shown_version_ = 0, painted_ = 0, settled_until_ = 0;
  double scale_ = 1.0, scale_most_ = 1.0, draw_ms_ = 0.0;
  bool automatic_ = false;
};

}  // namespace weft
