// Dear ImGui on our window and device: one small render pass that loads the drawn scene, draws the panels
// over it and hands the image to the display. (ImGui 1.86 knows no dynamic rendering.)
#pragma once
#include <vulkan/vulkan.h>

#include <vector>

#include "gpu/device.h"
#include "viewer/swapchain.h"
#include "viewer/window.h"

namespace weft {

class Gui {
 public:
  /// @param scale of text and widgets, 1 on an ordinary display
  Gui(gpu::Device&, Window&, const Swapchain&, float scale);
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  void begin_frame();
  /// Ends the frame's widgets without drawing them: the window had no image to draw on.
  void skip_frame();
  /// Draws the frame's widgets over `image`, which is in COLOR_ATTACHMENT_OPTIMAL; leaves it ready to
  /// present.
  void draw(VkCommandBuffer, const Swapchain&, const SwapchainImage& image);
  bool wants_mouse() const;
  bool wants_keyboard() const;

 private:
  void make_render_pass(VkFormat);
  void make_framebuffers(const Swapchain&);
  void destroy_framebuffers();
  void upload_fonts();

  gpu::Device& device_;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  VkRenderPass render_pass_ = VK_NULL_HANDLE;
  std::vector<VkFramebuffer> framebuffers_;
  std::uint64_t generation_ = 0;
};

}  // namespace weft
