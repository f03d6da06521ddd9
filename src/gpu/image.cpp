// Images: creation, and copies of their pixels from and to the host.
#include <cstring>
#include <utility>

#include "core/error.h"
#include "gpu/buffer.h"

namespace weft::gpu {
namespace {

void change_layout(VkCommandBuffer commands, const Image& image, VkImageLayout from, VkImageLayout to) {
  VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
  barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
  barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  barrier.oldLayout = from;
  barrier.newLayout = to;
  barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image.handle();
  barrier.subresourceRange = {image.options().aspect, 0, 1, 0, 1};
  VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  dependency.imageMemoryBarrierCount = 1;
  dependency.pImageMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &dependency);
}

VkBufferImageCopy whole(const ImageOptions& options) {
  VkBufferImageCopy region{};
  region.imageSubresource = {options.aspect, 0, 0, 1};
  region.imageExtent = {options.width, options.height, 1};
  return region;
}

VkDeviceSize pixel_bytes(const ImageOptions& options) {
  return VkDeviceSize{options.width} * options.height * texel_bytes(options.format);
}

void check_size(const Device& device, const std::string& name, const ImageOptions& options) {
  const std::uint32_t most = device.limits().maxImageDimension2D;
  if (options.width == 0 || options.height == 0 || options.width > most || options.height > most)
    throw error(Exit::usage, "Image {} is {}x{}; device \"{}\" makes images of 1 to {} pixels a side", name,
                options.width, options.height, device.info().name, most);
}

}  // namespace

std::uint32_t texel_bytes(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R8_UNORM: return 1;
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_R8G8B8A8_SRGB:
    case VK_FORMAT_B8G8R8A8_UNORM:
    case VK_FORMAT_B8G8R8A8_SRGB:
    case VK_FORMAT_R32_SFLOAT:
    case VK_FORMAT_R32_UINT:
    case VK_FORMAT_D32_SFLOAT: return 4;
    case VK_FORMAT_R32G32_SFLOAT:
    case VK_FORMAT_R32G32_UINT:
    case VK_FORMAT_R16G16B16A16_SFLOAT: return 8;
    case VK_FORMAT_R32G32B32A32_SFLOAT:
    case VK_FORMAT_R32G32B32A32_UINT: return 16;
    default: throw error(Exit::internal, "The size of a texel of format {} is not known", int{format});
  }
}

Image::Image(Device& device, const std::string& name, const ImageOptions& options)
    : device_(&device), options_(options) {
  check_size(device, name, options);
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = options.format;
  info.extent = {options.width, options.height, 1};
  info.mipLevels = 1;
  info.arrayLayers = 1;
  info.samples = options.samples;
  info.tiling = VK_IMAGE_TILING_OPTIMAL;
  info.usage = options.usage;
  check(vkCreateImage(device.handle(), &info, nullptr, &handle_), "create an image");
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(device.handle(), handle_, &needs);
  try {
    allocation_ = device.allocator().allocate(needs, Memory::device, true, "image " + name);
    check(vkBindImageMemory(device.handle(), handle_, allocation_.memory, allocation_.offset),
          "bind an image to its memory");
    VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    view.image = handle_;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = options.format;
    view.subresourceRange = {options.aspect, 0, 1, 0, 1};
    check(vkCreateImageView(device.handle(), &view, nullptr, &view_), "create an image view");
    device.name(VK_OBJECT_TYPE_IMAGE, handle_, name);
  } catch (...) {
    vkDestroyImageView(device.handle(), view_, nullptr);
    vkDestroyImage(device.handle(), handle_, nullptr);
    device.allocator().release(allocation_);
    throw;
  }
}

Image::~Image() {
  if (handle_ == VK_NULL_HANDLE) return;
  vkDestroyImageView(device_->handle(), view_, nullptr);
  vkDestroyImage(device_->handle(), handle_, nullptr);
  device_->allocator().release(allocation_);
}

Image::Image(Image&& other) noexcept { *this = std::move(other); }

Image& Image::operator=(Image&& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(handle_, other.handle_);
  std::swap(view_, other.view_);
  std::swap(options_, other.options_);
  std::swap(allocation_, other.allocation_);
  return *this;
}

std::vector<std::byte> read_image(Device& device, const Image& image, VkImageLayout layout) {
  const VkDeviceSize bytes = pixel_bytes(image.options());
  const Buffer pixels(device, "image read-back", bytes, 0, Memory::readback);
  device.run_once([&](VkCommandBuffer commands) {
    change_layout(commands, image, layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    const VkBufferImageCopy region = whole(image.options());
    vkCmdCopyImageToBuffer(commands, image.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, pixels.handle(), 1,
                           &region);
    change_layout(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, layout);
  });
  return {pixels.mapped(), pixels.mapped() + bytes};
}

void write_image(Device& device, const Image& image, std::span<const std::byte> data, VkImageLayout layout) {
  const VkDeviceSize bytes = pixel_bytes(image.options());
  if (data.size() != bytes)
    throw error(Exit::internal, "An image of {} bytes was given {}", bytes, data.size());
  const Buffer pixels(device, "image upload", bytes, 0, Memory::upload);
  std::memcpy(pixels.mapped(), data.data(), bytes);
  device.run_once([&](VkCommandBuffer commands) {
    change_layout(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    const VkBufferImageCopy region = whole(image.options());
    vkCmdCopyBufferToImage(commands, pixels.handle(), image.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                           &region);
    change_layout(commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, layout);
  });
}

}  // namespace weft::gpu
