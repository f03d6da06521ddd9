// The offscreen target and its read-back.
#include "render/offscreen.h"

#include <algorithm>
#include <span>

#include "core/error.h"

namespace weft {
namespace {

constexpr VkFormat kFormat = VK_FORMAT_R8G8B8A8_UNORM;

const RenderOptions& checked(gpu::Device& device, const RenderOptions& options) {
  const std::uint32_t most =
      std::min({device.limits().maxImageDimension2D, device.limits().maxFramebufferWidth,
                device.limits().maxFramebufferHeight, device.limits().maxViewportDimensions[0],
                device.limits().maxViewportDimensions[1]});
  const std::uint32_t low = std::min(options.width, options.height);
  const std::uint32_t high = std::max(options.width, options.height);
  if (low < 1 || high > most)
    throw error(Exit::usage, "The picture is {}x{} pixels; this device draws 1 to {} pixels a side (--size)",
                options.width, options.height, most);
  return options;
}

VkImageMemoryBarrier2 change(const gpu::Image& image, VkImageLayout from, VkImageLayout to) {
  VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
  barrier.image = image.handle();
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  barrier.oldLayout = from;
  barrier.newLayout = to;
  return barrier;
}

void apply(VkCommandBuffer commands, const VkImageMemoryBarrier2& barrier) {
  VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  dependency.imageMemoryBarrierCount = 1;
  dependency.pImageMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &dependency);
}

void begin_color(VkCommandBuffer commands, const gpu::Image& image) {
  VkImageMemoryBarrier2 barrier =
      change(image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
  barrier.dstStageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
  barrier.dstAccessMask = VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
  apply(commands, barrier);
}

void copy_out(VkCommandBuffer commands, const gpu::Image& image, const gpu::Buffer& pixels) {
  VkImageMemoryBarrier2 barrier =
      change(image, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  barrier.srcStageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
  barrier.srcAccessMask = VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
  barrier.dstStageMask = VK_PIPELINE_STAGE_2_COPY_BIT;
  barrier.dstAccessMask = VK_ACCESS_2_TRANSFER_READ_BIT;
  apply(commands, barrier);
  VkBufferImageCopy region{};
  region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  region.imageExtent = {image.options().width, image.options().height, 1};
  vkCmdCopyImageToBuffer(commands, image.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, pixels.handle(), 1,
                         &region);
}

}  // namespace

OffscreenRenderer::OffscreenRenderer(gpu::Device& device, const Model& model, const RenderOptions& options)
    : device_(device),
      options_(checked(device, options)),
      camera_(options.camera.value_or(
          default_camera(model, double{1.0} * options.width / options.height, options.film_s))),
      renderer_(device, model, kFormat, choose_samples(device, options.samples), options.film_s) {
  gpu::ImageOptions image;
  image.format = kFormat;
  image.width = options.width;
  image.height = options.height;
  image.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  color_ = gpu::Image(device, "picture", image);
  pixels_ = gpu::Buffer(device, "picture pixels", VkDeviceSize{4} * options.width * options.height,
                        VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Memory::readback);
}

Picture OffscreenRenderer::draw(const DrawBuffers& cloth, double time_s) {
  device_.run_once([&](VkCommandBuffer commands) {
    begin_color(commands, color_);
    const DrawTarget target{color_.view(), {options_.width, options_.height}};
    counts_ = renderer_.draw(commands, target, cloth, camera_, time_s, options_.look);
    copy_out(commands, color_, pixels_);
  });
  Picture picture{options_.width, options_.height, {}};
  picture.rgba.resize(pixels_.bytes());
  pixels_.read(std::as_writable_bytes(std::span(picture.rgba)));
  return picture;
}

Picture OffscreenRenderer::draw(const State& state) {
  if (!host_cloth_) host_cloth_.emplace(device_, renderer_.model().grid);
  host_cloth_->upload(state);
  return draw(host_cloth_->buffers(), state.time_s);
}

}  // namespace weft
