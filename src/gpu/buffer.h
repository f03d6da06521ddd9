// Buffers and images with their memory: a small block allocator, a real staging path, RAII.
#pragma once
#include <vulkan/vulkan.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "gpu/device.h"

namespace weft::gpu {

enum class Memory {
  device,    ///< fastest for the device; host visible only by luck
  upload,    ///< host writes, device reads
  readback,  ///< device writes, host reads (cached)
};

/// Suballocates VkDeviceMemory blocks by memory type. Counts what is live.
class Allocator {
 public:
  explicit Allocator(Device&, bool force_staging);
  ~Allocator();
  struct Allocation {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize offset = 0, size = 0;
    std::byte* mapped = nullptr;  ///< null when not host visible (or staging is forced)
    std::uint32_t block = 0;
  };
  /// @throws Error(Exit::no_device) with the bytes needed and the bytes there.
  Allocation allocate(const VkMemoryRequirements&, Memory, bool image, const std::string& name);
  void release(const Allocation&);
  std::uint64_t live_bytes() const;
  std::uint64_t live_count() const;
  /// Bytes of the largest device-local heap.
  std::uint64_t heap_bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

class Buffer {
 public:
  Buffer() = default;
  Buffer(Device&, std::string name, VkDeviceSize bytes, VkBufferUsageFlags usage, Memory);
  ~Buffer();
  Buffer(Buffer&&) noexcept;
  Buffer& operator=(Buffer&&) noexcept;
  VkBuffer handle() const { return handle_; }
  VkDeviceSize bytes() const { return bytes_; }
  std::byte* mapped() const { return allocation_.mapped; }
  const std::string& name() const { return name_; }
  explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }

  /// Copies through mapped memory, else through a staging buffer and a submit; returns when done.
  void write(std::span<const std::byte> data, VkDeviceSize offset = 0);
  void read(std::span<std::byte> data, VkDeviceSize offset = 0) const;

 private:
  Device* device_ = nullptr;
  std::string name_;
  VkBuffer handle_ = VK_NULL_HANDLE;
  VkDeviceSize bytes_ = 0;
  Allocator::Allocation allocation_;
};

struct ImageOptions {
  VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
  std::uint32_t width = 0, height = 0;
  VkImageUsageFlags usage = 0;
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
};

/// A 2-D image with its view.
class Image {
 public:
  Image() = default;
  Image(Device&, std::string name, const ImageOptions&);
  ~Image();
  Image(Image&&) noexcept;
  Image& operator=(Image&&) noexcept;
  VkImage handle() const { return handle_; }
  VkImageView view() const { return view_; }
  const ImageOptions& options() const { return options_; }

 private:
  Device* device_ = nullptr;
  VkImage handle_ = VK_NULL_HANDLE;
  VkImageView view_ = VK_NULL_HANDLE;
  ImageOptions options_;
  Allocator::Allocation allocation_;
};

}  // namespace weft::gpu
