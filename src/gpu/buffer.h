// Buffers and images with their memory: a small block allocator, a real staging path, RAII.
#pragma once
#include <vulkan/vulkan.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gpu/device.h"

namespace weft::gpu {

enum class Memory {
  device,    ///< fastest for the device; host visible only by luck
  upload,    ///< host writes, device reads
  readback,  ///< device writes, host reads (cached)
};

/// Suballocates VkDeviceMemory blocks by memory type; images and buffers never share a block, so
/// bufferImageGranularity cannot matter. Counts what is live.
class Allocator {
 public:
  explicit Allocator(Device&, bool force_staging);
  ~Allocator();
  struct Allocation {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize offset = 0, size = 0;
    std::byte* mapped = nullptr;  ///< null when not host visible (or staging is forced)
    bool cached = false;          ///< the host reads it at full speed
    std::uint64_t block = 0;
  };
  /// @throws Error(Exit::no_device) with the bytes needed and the bytes there.
  Allocation allocate(const VkMemoryRequirements&, Memory, bool image, const std::string& name);
  void release(const Allocation&);
  std::uint64_t live_bytes() const;  ///< of allocations, without what blocks hold in reserve
  std::uint64_t live_count() const;
  std::uint64_t block_bytes() const;  ///< taken from the driver
  std::uint64_t block_count() const;
  /// Bytes of the largest device-local heap.
  std::uint64_t heap_bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A buffer and its memory. Device and upload memory can always be copied from and to.
class Buffer {
 public:
  Buffer() = default;
  /// @param bytes  at least 1; a storage buffer at most the device's maxStorageBufferRange
  /// @throws Error(Exit::no_device) when the device cannot hold it: what is needed and what is there
  Buffer(Device&, std::string name, VkDeviceSize bytes, VkBufferUsageFlags usage, Memory);
  ~Buffer();
  Buffer(Buffer&&) noexcept;
  Buffer& operator=(Buffer&&) noexcept;
  VkBuffer handle() const { return handle_; }
  VkDeviceSize bytes() const { return bytes_; }
  std::byte* mapped() const { return allocation_.mapped; }
  const std::string& name() const { return name_; }
  explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }

  /// Waits for all submitted work, then copies: through mapped memory, else through a staging buffer and
  /// a submission of its own. Returns when done. For per-frame data write `mapped()` of upload memory.
  void write(std::span<const std::byte> data, VkDeviceSize offset = 0);
  void read(std::span<std::byte> data, VkDeviceSize offset = 0) const;
  /// The same for who knows that nothing submitted uses the buffer, or only reads what is read here: a
  /// picture that is being drawn is not waited for.
  void write_unused(std::span<const std::byte> data, VkDeviceSize offset = 0);
  void read_finished(std::span<std::byte> data, VkDeviceSize offset = 0) const;
  /// All of another buffer of as many bytes, on the device; the same holds for this one. Returns when done.
  void copy_unused(const Buffer& from);

  /// A view of the whole buffer for samplerBuffer or imageBuffer, made at the first call; the usage must
  /// hold VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT or VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT.
  /// @throws Error(Exit::no_device) when it holds more texels than the device's maxTexelBufferElements
  VkBufferView texel_view(VkFormat format) const;

 private:
  void check_range(std::size_t bytes, VkDeviceSize offset, const char* verb) const;
  Device* device_ = nullptr;
  std::string name_;
  VkBuffer handle_ = VK_NULL_HANDLE;
  VkDeviceSize bytes_ = 0;
  Allocator::Allocation allocation_;
  mutable std::vector<std::pair<VkFormat, VkBufferView>> views_;
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
  Image(Device&, const std::string& name, const ImageOptions&);
  ~Image();
  Image(Image&&) noexcept;
  Image& operator=(Image&&) noexcept;
  VkImage handle() const { return handle_; }
  explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }
  VkImageView view() const { return view_; }
  const ImageOptions& options() const { return options_; }

 private:
  Device* device_ = nullptr;
  VkImage handle_ = VK_NULL_HANDLE;
  VkImageView view_ = VK_NULL_HANDLE;
  ImageOptions options_;
  Allocator::Allocation allocation_;
};

/// Bytes of one texel. @throws Error(Exit::internal) for formats Weft does not use.
std::uint32_t texel_bytes(VkFormat format);

/// The pixels of a one-sample image, rows from the top, tightly packed. Waits for all submitted work.
/// @param layout  the image's layout now; it is left in it
std::vector<std::byte> read_image(Device&, const Image&, VkImageLayout layout);

/// Fills an image; it ends in `layout`. The usage must hold VK_IMAGE_USAGE_TRANSFER_DST_BIT.
void write_image(Device&, const Image&, std::span<const std::byte> pixels, VkImageLayout layout);

}  // namespace weft::gpu
