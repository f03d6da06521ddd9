// The window's images: made anew when the window changes or the system takes them away, never of size 0.
#pragma once
#include <vulkan/vulkan.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "viewer/window.h"

namespace weft {

/// A surface that outlives the device made for it; destroyed before the instance.
class Surface {
 public:
  Surface(const gpu::Device&, const Window&);
  ~Surface();
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;
  VkSurfaceKHR handle() const { return handle_; }
  void recreate();  ///< after VK_ERROR_SURFACE_LOST_KHR

 private:
  const gpu::Device& device_;
  const Window& window_;
  VkSurfaceKHR handle_ = VK_NULL_HANDLE;
};

struct SwapchainImage {
  std::uint32_t index = 0;
  VkImage image = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  VkSemaphore drawn = VK_NULL_HANDLE;  ///< to be signalled when the picture is ready to show
};

/// Debug switch in the environment: WEFT_SIMULATE_SURFACE_LOSS_AFTER=n lets the surface be lost once, after n
/// pictures.
class Swapchain {
 public:
  /// @param present_mode "fifo", "mailbox", "immediate", or empty for fifo
  /// @throws Error(Exit::usage) when the surface does not offer the mode, naming those it does
  /// @throws Error(Exit::no_device) when the device cannot show a picture on the window
  Swapchain(gpu::Device&, Surface&, const std::string& present_mode);
  ~Swapchain();
  Swapchain(const Swapchain&) = delete;
  Swapchain& operator=(const Swapchain&) = delete;

  /// The next image to draw on, made anew first when needed; nothing when the window has no area or the
  /// images were just lost (ask again in a while).
  /// @param acquired signalled when the image may be written
  std::optional<SwapchainImage> acquire(VkSemaphore acquired, WindowSize framebuffer);
  void present(const SwapchainImage&);
  /// Modes the surface offers, by their names above.
  std::vector<std::string> present_modes() const;
  const std::string& present_mode() const { return mode_name_; }
  void set_present_mode(const std::string&);

  VkFormat format() const { return format_.format; }
  VkExtent2D extent() const { return extent_; }
  std::uint32_t image_count() const { return static_cast<std::uint32_t>(images_.size()); }
  std::uint64_t generation() const { return generation_; }  ///< changes when the images do
  const std::vector<SwapchainImage>& images() const { return images_; }

 private:
  void choose_format();
  bool recreate(WindowSize framebuffer);
  void replace_surface();
  void make_images();
  void destroy_images();

  gpu::Device& device_;
  Surface& surface_;
  VkSurfaceFormatKHR format_{};
  VkPresentModeKHR mode_ = VK_PRESENT_MODE_FIFO_KHR;
  std::string mode_name_;
  VkSwapchainKHR handle_ = VK_NULL_HANDLE;
  VkExtent2D extent_{};
  WindowSize made_for_;
  std::vector<SwapchainImage> images_;
  std::uint64_t generation_ = 0;
  bool stale_ = true;
  std::uint64_t images_until_loss_ = 0;  // 0: no loss is simulated
};

}  // namespace weft
