// A command buffer with its pool: recorded once, submitted once or many times.
#pragma once
#include <vulkan/vulkan.h>

#include <functional>
#include <string>

#include "gpu/device.h"

namespace weft::gpu {

enum class Reuse {
  once,  ///< recorded for one submission
  many,  ///< submitted again and again, also while an earlier submission still runs
};

/// A primary command buffer in a pool of its own. The caller waits for its submissions before it is
/// recorded again or destroyed.
class Commands {
 public:
  Commands() = default;
  Commands(Device&, std::string name, Reuse reuse = Reuse::once);
  ~Commands();
  Commands(Commands&&) noexcept;
  Commands& operator=(Commands&&) noexcept;
  VkCommandBuffer handle() const { return handle_; }
  const std::string& name() const { return name_; }
  explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }

  /// Forgets what was recorded, then records what `recorder` writes.
  void record(const std::function<void(VkCommandBuffer)>& recorder);
  /// The same in two calls.
  VkCommandBuffer begin();
  void end();

 private:
  Device* device_ = nullptr;
  std::string name_;
  Reuse reuse_ = Reuse::once;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  VkCommandBuffer handle_ = VK_NULL_HANDLE;
};

}  // namespace weft::gpu
