// Surface format and present mode, creation and loss of the window's images.
#include "viewer/swapchain.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <utility>

#include "core/error.h"

namespace weft {
namespace {

struct ModeName {
  VkPresentModeKHR mode;
  const char* name;
};
constexpr std::array kModes = {ModeName{VK_PRESENT_MODE_FIFO_KHR, "fifo"},
                               ModeName{VK_PRESENT_MODE_MAILBOX_KHR, "mailbox"},
                               ModeName{VK_PRESENT_MODE_IMMEDIATE_KHR, "immediate"}};

/// Vulkan's two-call enumeration.
template <class T, class Ask>
std::vector<T> enumerate(Ask&& ask, const char* wish) {
  std::uint32_t count = 0;
  gpu::check(ask(&count, nullptr), wish);
  std::vector<T> items(count);
  const VkResult result = ask(&count, items.data());
  if (result != VK_INCOMPLETE) gpu::check(result, wish);
  items.resize(count);
  return items;
}

VkExtent2D fitting_extent(const VkSurfaceCapabilitiesKHR& can, WindowSize framebuffer) {
  if (can.currentExtent.width != std::numeric_limits<std::uint32_t>::max()) return can.currentExtent;
  return {std::clamp(framebuffer.width, can.minImageExtent.width, can.maxImageExtent.width),
          std::clamp(framebuffer.height, can.minImageExtent.height, can.maxImageExtent.height)};
}

VkCompositeAlphaFlagBitsKHR opaque_if_possible(VkCompositeAlphaFlagsKHR supported) {
  if ((supported & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR) != 0) return VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
  return (supported & VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR) != 0 ? VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR
                                                               : VK_COMPOSITE_ALPHA_PRE_MULTIPLIED_BIT_KHR;
}

}  // namespace

Surface::Surface(const gpu::Device& device, const Window& window)
    : device_(device), window_(window), handle_(window.create_surface(device.instance())) {}

Surface::~Surface() { vkDestroySurfaceKHR(device_.instance(), handle_, nullptr); }

void Surface::recreate() {
  vkDestroySurfaceKHR(device_.instance(), std::exchange(handle_, VK_NULL_HANDLE), nullptr);
  handle_ = window_.create_surface(device_.instance());
}

Swapchain::Swapchain(gpu::Device& device, Surface& surface, const std::string& present_mode)
    : device_(device), surface_(surface) {
  VkBool32 supported = VK_FALSE;
  gpu::check(vkGetPhysicalDeviceSurfaceSupportKHR(device.physical(), device.queue_family(), surface.handle(),
                                                  &supported),
             "whether the device can show pictures on the window");
  if (supported != VK_TRUE)
    throw error(
        Exit::no_device,
        "{} cannot show pictures on this display; choose another device with --device (weft devices lists "
        "them), or use weft render",
        device.info().name);
  choose_format();
  set_present_mode(present_mode);
  if (const char* count = std::getenv("WEFT_SIMULATE_SURFACE_LOSS_AFTER"))
    images_until_loss_ = std::strtoull(count, nullptr, 10) + 1;
}

Swapchain::~Swapchain() {
  destroy_images();
  vkDestroySwapchainKHR(device_.handle(), handle_, nullptr);
}

void Swapchain::choose_format() {
  const auto formats = enumerate<VkSurfaceFormatKHR>(
      [&](std::uint32_t* count, VkSurfaceFormatKHR* data) {
        return vkGetPhysicalDeviceSurfaceFormatsKHR(device_.physical(), surface_.handle(), count, data);
      },
      "the window's colour formats");
  for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM}) {
    for (const VkSurfaceFormatKHR& format : formats) {
      if (format.format != wanted || format.colorSpace != VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) continue;
      format_ = format;
      return;
    }
  }
  throw error(Exit::no_device, "the window offers no 8-bit colour format; use weft render instead");
}

std::vector<std::string> Swapchain::present_modes() const {
  const auto offered = enumerate<VkPresentModeKHR>(
      [&](std::uint32_t* count, VkPresentModeKHR* data) {
        return vkGetPhysicalDeviceSurfacePresentModesKHR(device_.physical(), surface_.handle(), count, data);
      },
      "the window's present modes");
  std::vector<std::string> names;
  for (const ModeName& mode : kModes)
    if (std::ranges::find(offered, mode.mode) != offered.end()) names.emplace_back(mode.name);
  return names;
}

void Swapchain::set_present_mode(const std::string& name) {
  const std::string wanted = name.empty() ? "fifo" : name;
  const std::vector<std::string> offered = present_modes();
  if (std::ranges::find(offered, wanted) == offered.end())
    throw error(Exit::usage, "present mode {} is not offered by this display; it must be one of {}", wanted,
                fmt::join(offered, ", "));
  for (const ModeName& mode : kModes)
    if (wanted == mode.name) mode_ = mode.mode;
  mode_name_ = wanted;
  stale_ = true;
}

bool Swapchain::recreate(WindowSize framebuffer) {
  VkSurfaceCapabilitiesKHR can{};
  const VkResult asked =
      vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_.physical(), surface_.handle(), &can);
  if (asked == VK_ERROR_SURFACE_LOST_KHR) {
    replace_surface();
    return false;
  }
  gpu::check(asked, "what the window's surface can do");
  const VkExtent2D extent = fitting_extent(can, framebuffer);
  if (extent.width == 0 || extent.height == 0) return false;
  device_.wait_idle();
  destroy_images();

  VkSwapchainCreateInfoKHR info{};

  info.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR;
  info.surface = surface_.handle();
  info.minImageCount = std::max(3u, can.minImageCount);
  if (can.maxImageCount != 0) info.minImageCount = std::min(info.minImageCount, can.maxImageCount);
  info.imageFormat = format_.format;
  info.imageColorSpace = format_.colorSpace;
  info.imageExtent = extent;
  info.imageArrayLayers = 1;
  info.imageUsage =
      VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
      (can.supportedUsageFlags & (VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT));
  info.preTransform = can.currentTransform;
  info.compositeAlpha = opaque_if_possible(can.supportedCompositeAlpha);
  info.presentMode = mode_;
  info.clipped = VK_TRUE;
  info.oldSwapchain = handle_;
  VkSwapchainKHR created = VK_NULL_HANDLE;
  const VkResult result = vkCreateSwapchainKHR(device_.handle(), &info, nullptr, &created);
  vkDestroySwapchainKHR(device_.handle(), std::exchange(handle_, created), nullptr);
  if (result == VK_ERROR_SURFACE_LOST_KHR) surface_.recreate();
  if (result == VK_ERROR_SURFACE_LOST_KHR || result == VK_ERROR_OUT_OF_DATE_KHR) return false;
  gpu::check(result, "images for the window");
  extent_ = extent;
  made_for_ = framebuffer;
  make_images();
  return true;
}

void Swapchain::replace_surface() {
  device_.wait_idle();
  destroy_images();
  vkDestroySwapchainKHR(device_.handle(), std::exchange(handle_, VK_NULL_HANDLE), nullptr);
  surface_.recreate();
}

void Swapchain::make_images() {
  const auto images = enumerate<VkImage>(
      [&](std::uint32_t* count, VkImage* data) {
        return vkGetSwapchainImagesKHR(device_.handle(), handle_, count, data);
      },
      "the window's images");
  for (std::uint32_t i = 0; i < images.size(); ++i) {
    SwapchainImage made{.index = i, .image = images[i]};
    VkImageViewCreateInfo view{};
    view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    view.image = images[i];
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format_.format;
    view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    gpu::check(vkCreateImageView(device_.handle(), &view, nullptr, &made.view), "a view of a window image");
    VkSemaphoreCreateInfo semaphore{};
    semaphore.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
    gpu::check(vkCreateSemaphore(device_.handle(), &semaphore, nullptr, &made.drawn), "a semaphore");
    images_.push_back(made);
  }
  ++generation_;
  stale_ = false;
}

void Swapchain::destroy_images() {
  for (const SwapchainImage& image : images_) {
    vkDestroyImageView(device_.handle(), image.view, nullptr);
    vkDestroySemaphore(device_.handle(), image.drawn, nullptr);
  }
  images_.clear();
  stale_ = true;
}

std::optional<SwapchainImage> Swapchain::acquire(VkSemaphore acquired, WindowSize framebuffer) {
  if (framebuffer.empty()) return std::nullopt;
  if (images_until_loss_ > 0 && --images_until_loss_ == 0) {
    replace_surface();
    return std::nullopt;
  }
  if (made_for_ != framebuffer) stale_ = true;
  if (stale_ && !recreate(framebuffer)) return std::nullopt;
  std::uint32_t index = 0;
  constexpr std::uint64_t kPatience_ns = 1'000'000'000;  // a hidden window may hold its images back
  const VkResult result =
      vkAcquireNextImageKHR(device_.handle(), handle_, kPatience_ns, acquired, VK_NULL_HANDLE, &index);
  if (result == VK_TIMEOUT || result == VK_NOT_READY) return std::nullopt;
  if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_ERROR_SURFACE_LOST_KHR) {
    stale_ = true;
    return std::nullopt;
  }
  if (result == VK_SUBOPTIMAL_KHR) {
    stale_ = true;  // this picture can still be shown; the next is drawn on new images
  } else {
    gpu::check(result, "the window's next image");
  }
  return images_[index];
}

void Swapchain::present(const SwapchainImage& image) {
  VkPresentInfoKHR info{};
  info.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR;
  info.waitSemaphoreCount = 1;
  info.pWaitSemaphores = &image.drawn;
  info.swapchainCount = 1;
  info.pSwapchains = &handle_;
  info.pImageIndices = &image.index;
  const VkResult result = device_.present(info);
  if (result == VK_SUBOPTIMAL_KHR || result == VK_ERROR_OUT_OF_DATE_KHR ||
      result == VK_ERROR_SURFACE_LOST_KHR) {
    stale_ = true;
    return;
  }
  gpu::check(result, "showing a picture on the window");
}

}  // namespace weft
