// The Vulkan instance with its validation messages, and what can be said of each physical device.
// Internal to src/gpu.
#pragma once
#include <vulkan/vulkan.h>

#include <mutex>
#include <string>
#include <vector>

#include "gpu/device.h"

namespace weft::gpu {

/// Messages of the validation layer; drivers may call from any thread.
class MessageLog {
 public:
  void add(std::string text);
  std::vector<std::string> all() const;
  void clear();

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> messages_;
};

/// A 1.3 instance, with VK_EXT_debug_utils when the loader has it.
class Instance {
 public:
  /// @throws Error(Exit::no_device) when a wanted layer or extension is missing, or there is no driver.
  Instance(bool validation, const std::vector<const char*>& extensions);
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  VkInstance handle() const { return handle_; }
  bool debug_utils() const { return debug_utils_; }
  MessageLog& messages() { return messages_; }
  const MessageLog& messages() const { return messages_; }
  template <class Function>
  Function function(const char* name) const {
    return reinterpret_cast<Function>(vkGetInstanceProcAddr(handle_, name));
  }

 private:
  void create_messenger(const VkDebugUtilsMessengerCreateInfoEXT&);
  VkInstance handle_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  bool debug_utils_ = false;
  MessageLog messages_;
};

/// A physical device, what is known of it, and its queue family for graphics and compute.
struct Candidate {
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  DeviceInfo info;
  std::uint32_t queue_family = 0;
};

/// Ranked as list_devices() says; `info.index` is the place.
std::vector<Candidate> ranked_devices(VkInstance);

/// The one that `choice` means.
/// @throws Error(Exit::no_device) naming the devices there are and why each will not do.
Candidate choose_device(const std::vector<Candidate>&, const std::string& choice);

}  // namespace weft::gpu
