// Commands: one pool, one primary command buffer.
#include "gpu/commands.h"

#include <utility>

namespace weft::gpu {

Commands::Commands(Device& device, std::string name, Reuse reuse)
    : device_(&device), name_(std::move(name)), reuse_(reuse) {
  VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  pool.flags = reuse == Reuse::once ? VK_COMMAND_POOL_CREATE_TRANSIENT_BIT : 0;
  pool.queueFamilyIndex = device.queue_family();
  check(vkCreateCommandPool(device.handle(), &pool, nullptr, &pool_), "create a command pool");
  VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  info.commandPool = pool_;
  info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  info.commandBufferCount = 1;
  const VkResult result = vkAllocateCommandBuffers(device.handle(), &info, &handle_);
  if (result != VK_SUCCESS) {
    vkDestroyCommandPool(device.handle(), pool_, nullptr);
    check(result, "allocate a command buffer");
  }
  device.name(VK_OBJECT_TYPE_COMMAND_BUFFER, handle_, name_);
}

Commands::~Commands() {
  if (pool_ != VK_NULL_HANDLE) vkDestroyCommandPool(device_->handle(), pool_, nullptr);
}

Commands::Commands(Commands&& other) noexcept { *this = std::move(other); }

Commands& Commands::operator=(Commands&& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(name_, other.name_);
  std::swap(reuse_, other.reuse_);
  std::swap(pool_, other.pool_);
  std::swap(handle_, other.handle_);
  return *this;
}

VkCommandBuffer Commands::begin() {
  check(vkResetCommandPool(device_->handle(), pool_, 0), "reset a command pool");
  VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  info.flags = reuse_ == Reuse::many ? VK_COMMAND_BUFFER_USAGE_SIMULTANEOUS_USE_BIT
                                     : VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(handle_, &info), "begin recording");
  return handle_;
}

void Commands::end() { check(vkEndCommandBuffer(handle_), "end recording"); }

void Commands::record(const std::function<void(VkCommandBuffer)>& recorder) {
  begin();
  recorder(handle_);
  end();
}

}  // namespace weft::gpu
