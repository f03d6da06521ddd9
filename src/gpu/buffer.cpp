// Buffers: creation within the device's limits, host access, texel views.
#include "gpu/buffer.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "core/error.h"

namespace weft::gpu {
namespace {

constexpr VkDeviceSize kStagingBytes = VkDeviceSize{16} << 20;

void check_limits(const Device& device, const std::string& name, VkDeviceSize bytes,
                  VkBufferUsageFlags usage) {
  if (bytes == 0) throw error(Exit::internal, "Buffer {} has no bytes; an empty buffer is not created", name);
  const bool storage = (usage & VK_BUFFER_USAGE_STORAGE_BUFFER_BIT) != 0;
  const VkDeviceSize most =
      storage ? std::min<VkDeviceSize>(device.limits().maxStorageBufferRange, device.buffer_bytes_max())
              : device.buffer_bytes_max();
  if (bytes > most) {
    throw error(Exit::no_device,
                "Buffer {} needs {} bytes, and a {}buffer on device \"{}\" holds at most {}; lower the "
                "resolution, or choose another --device",
                name, bytes, storage ? "storage " : "", device.info().name, most);
  }
}

void copy(Device& device, VkBuffer from, VkDeviceSize from_offset, VkBuffer to, VkDeviceSize to_offset,
          VkDeviceSize bytes) {
  device.run_once([&](VkCommandBuffer commands) {
    const VkBufferCopy region{from_offset, to_offset, bytes};
    vkCmdCopyBuffer(commands, from, to, 1, &region);
  });
}

}  // namespace

Buffer::Buffer(Device& device, std::string name, VkDeviceSize bytes, VkBufferUsageFlags usage, Memory memory)
    : device_(&device), name_(std::move(name)), bytes_(bytes) {
  check_limits(device, name_, bytes, usage);
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = bytes;
  info.usage = usage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  check(vkCreateBuffer(device.handle(), &info, nullptr, &handle_), "create a buffer");
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(device.handle(), handle_, &needs);
  try {
    allocation_ = device.allocator().allocate(needs, memory, false, "buffer " + name_);
    check(vkBindBufferMemory(device.handle(), handle_, allocation_.memory, allocation_.offset),
          "bind a buffer to its memory");
    device.name(VK_OBJECT_TYPE_BUFFER, handle_, name_);
  } catch (...) {
    vkDestroyBuffer(device.handle(), handle_, nullptr);
    device.allocator().release(allocation_);
    throw;
  }
}

Buffer::~Buffer() {
  if (handle_ == VK_NULL_HANDLE) return;
  for (const auto& [format, view] : views_) vkDestroyBufferView(device_->handle(), view, nullptr);
  vkDestroyBuffer(device_->handle(), handle_, nullptr);
  device_->allocator().release(allocation_);
}

Buffer::Buffer(Buffer&& other) noexcept { *this = std::move(other); }

Buffer& Buffer::operator=(Buffer&& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(name_, other.name_);
  std::swap(handle_, other.handle_);
  std::swap(bytes_, other.bytes_);
  std::swap(allocation_, other.allocation_);
  std::swap(views_, other.views_);
  return *this;
}

void Buffer::check_range(std::size_t bytes, VkDeviceSize offset, const char* verb) const {
  if (offset > bytes_ || bytes > bytes_ - offset)
    throw error(Exit::internal, "Cannot {} {} bytes at {} of buffer {}, which holds {}", verb, bytes, offset,
                name_, bytes_);
}

void Buffer::write(std::span<const std::byte> data, VkDeviceSize offset) {
  device_->wait(device_->submitted());
  write_unused(data, offset);
}

void Buffer::read(std::span<std::byte> data, VkDeviceSize offset) const {
  device_->wait(device_->submitted());
  read_finished(data, offset);
}

void Buffer::write_unused(std::span<const std::byte> data, VkDeviceSize offset) {
  check_range(data.size(), offset, "write");
  if (data.empty()) return;
  if (allocation_.mapped != nullptr) {
    std::memcpy(allocation_.mapped + offset, data.data(), data.size());
    return;
  }
  const VkDeviceSize piece = std::min<VkDeviceSize>(data.size(), kStagingBytes);
  const Buffer staging(*device_, "staging of " + name_, piece, 0, Memory::upload);
  for (VkDeviceSize done = 0; done < data.size(); done += piece) {
    const VkDeviceSize bytes = std::min<VkDeviceSize>(piece, data.size() - done);
    std::memcpy(staging.mapped(), data.data() + done, bytes);
    copy(*device_, staging.handle_, 0, handle_, offset + done, bytes);
  }
}

void Buffer::read_finished(std::span<std::byte> data, VkDeviceSize offset) const {
  check_range(data.size(), offset, "read");
  if (data.empty()) return;
  // Uncached memory is read over the bus word by word; a copy on the device first is far faster.
  if (allocation_.mapped != nullptr && (allocation_.cached || data.size() <= 256)) {
    std::memcpy(data.data(), allocation_.mapped + offset, data.size());
    return;
  }
  const VkDeviceSize piece = std::min<VkDeviceSize>(data.size(), kStagingBytes);
  const Buffer staging(*device_, "staging of " + name_, piece, 0, Memory::readback);
  for (VkDeviceSize done = 0; done < data.size(); done += piece) {
    const VkDeviceSize bytes = std::min<VkDeviceSize>(piece, data.size() - done);
    copy(*device_, handle_, offset + done, staging.handle_, 0, bytes);
    std::memcpy(data.data() + done, staging.mapped(), bytes);
  }
}

void Buffer::copy_unused(const Buffer& from) {
  check_range(from.bytes_, 0, "copy");
  copy(*device_, from.handle_, 0, handle_, 0, from.bytes_);
}

VkBufferView Buffer::texel_view(VkFormat format) const {
  for (const auto& [known, view] : views_)
    if (known == format) return view;
  const VkDeviceSize texels = bytes_ / texel_bytes(format);
  if (texels > device_->limits().maxTexelBufferElements) {
    throw error(Exit::no_device,
                "Buffer {} holds {} texels, and device \"{}\" reads at most {}; lower the resolution, or "
                "choose another --device",
                name_, texels, device_->info().name, device_->limits().maxTexelBufferElements);
  }
  VkBufferViewCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
  info.buffer = handle_;
  info.format = format;
  info.range = VK_WHOLE_SIZE;
  VkBufferView view = VK_NULL_HANDLE;
  check(vkCreateBufferView(device_->handle(), &info, nullptr, &view), "create a texel view");
  views_.emplace_back(format, view);
  return view;
}

}  // namespace weft::gpu
