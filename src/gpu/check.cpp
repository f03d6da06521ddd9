// Vulkan's answers as errors for a person.
#include "core/error.h"
#include "gpu/device.h"

namespace weft::gpu {
namespace {

const char* result_name(VkResult result) {
  switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY: return "VK_ERROR_OUT_OF_HOST_MEMORY";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY: return "VK_ERROR_OUT_OF_DEVICE_MEMORY";
    case VK_ERROR_INITIALIZATION_FAILED: return "VK_ERROR_INITIALIZATION_FAILED";
    case VK_ERROR_DEVICE_LOST: return "VK_ERROR_DEVICE_LOST";
    case VK_ERROR_MEMORY_MAP_FAILED: return "VK_ERROR_MEMORY_MAP_FAILED";
    case VK_ERROR_LAYER_NOT_PRESENT: return "VK_ERROR_LAYER_NOT_PRESENT";
    case VK_ERROR_EXTENSION_NOT_PRESENT: return "VK_ERROR_EXTENSION_NOT_PRESENT";
    case VK_ERROR_FEATURE_NOT_PRESENT: return "VK_ERROR_FEATURE_NOT_PRESENT";
    case VK_ERROR_INCOMPATIBLE_DRIVER: return "VK_ERROR_INCOMPATIBLE_DRIVER";
    case VK_ERROR_TOO_MANY_OBJECTS: return "VK_ERROR_TOO_MANY_OBJECTS";
    case VK_ERROR_FORMAT_NOT_SUPPORTED: return "VK_ERROR_FORMAT_NOT_SUPPORTED";
    case VK_ERROR_FRAGMENTED_POOL: return "VK_ERROR_FRAGMENTED_POOL";
    case VK_ERROR_OUT_OF_POOL_MEMORY: return "VK_ERROR_OUT_OF_POOL_MEMORY";
    case VK_ERROR_SURFACE_LOST_KHR: return "VK_ERROR_SURFACE_LOST_KHR";
    case VK_ERROR_OUT_OF_DATE_KHR: return "VK_ERROR_OUT_OF_DATE_KHR";
    case VK_ERROR_INVALID_SHADER_NV: return "VK_ERROR_INVALID_SHADER";
    case VK_TIMEOUT: return "VK_TIMEOUT";
    case VK_NOT_READY: return "VK_NOT_READY";
    case VK_INCOMPLETE: return "VK_INCOMPLETE";
    default: return "an unexpected answer";
  }
}

}  // namespace

void check(VkResult result, const char* wish) {
  switch (result) {
    case VK_SUCCESS: return;
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
      throw error(Exit::no_device,
                  "Vulkan could not {}: the device's memory is used up ({}); lower the resolution, close "
                  "other programs that use the device, or choose another --device",
                  wish, result_name(result));
    case VK_ERROR_OUT_OF_HOST_MEMORY:
      throw error(Exit::no_device,
                  "Vulkan could not {}: the computer's memory is used up ({}); lower the resolution or close "
                  "other programs",
                  wish, result_name(result));
    case VK_ERROR_DEVICE_LOST:
      throw error(Exit::no_device,
                  "Vulkan could not {}: the device was lost ({}), by a driver reset or because one piece of "
                  "work took too long; start again, lower the resolution or the substeps, or choose another "
                  "--device",
                  wish, result_name(result));
    case VK_ERROR_INCOMPATIBLE_DRIVER:
      throw error(
          Exit::no_device,
          "Vulkan could not {}: no Vulkan driver is installed or it does not start ({}); install one "
          "(Debian: mesa-vulkan-drivers, which also brings a software device), or compute without one (weft "
          "simulate --device native)",
          wish, result_name(result));
    default:
      throw error(Exit::internal, "Vulkan could not {}: {} ({})", wish, result_name(result),
                  static_cast<int>(result));
  }
}

}  // namespace weft::gpu
