// The memory allocator: growing blocks with free lists, one list of blocks a memory type and kind.
#include <algorithm>
#include <bit>
#include <map>
#include <mutex>
#include <optional>

#include "core/environment.h"
#include "core/error.h"
#include "gpu/buffer.h"

namespace weft::gpu {
namespace {

constexpr VkDeviceSize kFirstBlockBytes = VkDeviceSize{4} << 20;
constexpr VkDeviceSize kLargestBlockBytes = VkDeviceSize{64} << 20;

constexpr VkMemoryPropertyFlags kLocal = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
constexpr VkMemoryPropertyFlags kHost =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
constexpr VkMemoryPropertyFlags kCached = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;

VkDeviceSize align_up(VkDeviceSize value, VkDeviceSize alignment) {
  return (value + alignment - 1) / alignment * alignment;
}

double mebibytes(VkDeviceSize bytes) { return static_cast<double>(bytes) / (1024.0 * 1024.0); }

struct Block {
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkDeviceSize bytes = 0;
  std::uint32_t type = 0;
  bool image = false;
  bool dedicated = false;
  std::byte* mapped = nullptr;
  std::map<VkDeviceSize, VkDeviceSize> free;  ///< offset → bytes; neighbours are merged
  std::uint64_t live = 0;

  std::optional<VkDeviceSize> take(VkDeviceSize wanted, VkDeviceSize alignment);
  void give_back(VkDeviceSize offset, VkDeviceSize size);
};

/// First fit. The gap that alignment leaves stays in the free list.
std::optional<VkDeviceSize> Block::take(VkDeviceSize wanted, VkDeviceSize alignment) {
  for (auto range = free.begin(); range != free.end(); ++range) {
    const VkDeviceSize begin = range->first, end = range->first + range->second;
    const VkDeviceSize offset = align_up(begin, alignment);
    if (offset + wanted > end) continue;
    free.erase(range);
    if (offset > begin) free[begin] = offset - begin;
    if (offset + wanted < end) free[offset + wanted] = end - offset - wanted;
    ++live;
    return offset;
  }
  return std::nullopt;
}

void Block::give_back(VkDeviceSize offset, VkDeviceSize size) {
  --live;
  auto range = free.emplace(offset, size).first;
  const auto next = std::next(range);
  if (next != free.end() && range->first + range->second == next->first) {
    range->second += next->second;
    free.erase(next);
  }
  if (range == free.begin()) return;
  const auto previous = std::prev(range);
  if (previous->first + previous->second != range->first) return;
  previous->second += range->second;
  free.erase(range);
}

}  // namespace

struct Allocator::Impl {
  Impl(Device& owner, bool staging) : device(owner), force_staging(staging) {}
  Device& device;
  bool force_staging;
  std::optional<std::uint64_t> fail_after_bytes;
  VkPhysicalDeviceMemoryProperties properties{};
  VkDeviceSize largest_allocation = 0;
  mutable std::mutex mutex;
  std::map<std::uint64_t, Block> blocks;  ///< by identity, which Allocation::block holds
  std::uint64_t next_block = 1;
  std::uint64_t live_bytes = 0, live_count = 0;

  std::vector<std::uint32_t> types_for(std::uint32_t allowed, Memory memory, bool image) const;
  int type_rank(std::uint32_t type, Memory memory, bool image) const;
  VkMemoryPropertyFlags flags(std::uint32_t type) const { return properties.memoryTypes[type].propertyFlags; }
  VkDeviceSize heap_size(std::uint32_t type) const {
    return properties.memoryHeaps[properties.memoryTypes[type].heapIndex].size;
  }
  VkDeviceSize taken_from_heap_of(std::uint32_t type) const;
  VkDeviceSize next_block_bytes(std::uint32_t type, bool image) const;
  Block* add_block(std::uint32_t type, VkDeviceSize bytes, bool image, bool dedicated, std::uint64_t& id);
  std::optional<Allocation> from_type(std::uint32_t type, const VkMemoryRequirements&, bool image);
  Allocation carve(std::uint64_t id, Block& block, VkDeviceSize offset, VkDeviceSize bytes) const;
  [[noreturn]] void fail(const VkMemoryRequirements&, std::uint32_t type, const std::string& name) const;
};

/// Lower is better, negative is out of the question.
int Allocator::Impl::type_rank(std::uint32_t type, Memory memory, bool image) const {
  const VkMemoryPropertyFlags f = flags(type);
  const bool local = (f & kLocal) != 0, host = (f & kHost) == kHost, cached = (f & kCached) != 0;
  if ((f & ~(kLocal | kHost | kCached)) != 0) return -1;  // lazily allocated, protected, vendor kinds
  switch (memory) {
    case Memory::upload: return host ? (local ? 2 : 0) + (cached ? 1 : 0) : -1;
    case Memory::readback: return host ? (cached ? 0 : 2) + (local ? 1 : 0) : -1;
    case Memory::device: break;
  }
  if (!local) return -1;
  // A small host-visible window into a large device memory is for others; the whole memory is for us.
  const bool whole = heap_size(type) * 2 > device.info().memory_bytes;
  if (force_staging || image) return (host ? 1 : 0) + (whole ? 0 : 2);
  return (host ? 0 : 1) + (whole ? 0 : 2);
}

std::vector<std::uint32_t> Allocator::Impl::types_for(std::uint32_t allowed, Memory memory,
                                                      bool image) const {
  std::vector<std::uint32_t> types;
  for (std::uint32_t t = 0; t < properties.memoryTypeCount; ++t)
    if ((allowed >> t & 1u) != 0 && type_rank(t, memory, image) >= 0) types.push_back(t);
  std::stable_sort(types.begin(), types.end(), [&](std::uint32_t a, std::uint32_t b) {
    return type_rank(a, memory, image) < type_rank(b, memory, image);
  });
  return types;
}

VkDeviceSize Allocator::Impl::taken_from_heap_of(std::uint32_t type) const {
  VkDeviceSize bytes = 0;
  for (const auto& [id, block] : blocks)
    if (properties.memoryTypes[block.type].heapIndex == properties.memoryTypes[type].heapIndex)
      bytes += block.bytes;
  return bytes;
}

VkDeviceSize Allocator::Impl::next_block_bytes(std::uint32_t type, bool image) const {
  VkDeviceSize bytes = kFirstBlockBytes;
  for (const auto& [id, block] : blocks)
    if (block.type == type && block.image == image && !block.dedicated)
      bytes = std::min(2 * bytes, kLargestBlockBytes);
  return std::min(bytes, std::bit_floor(std::max<VkDeviceSize>(heap_size(type) / 8, 1)));
}

/// Null when the driver or the heap has no room.
Block* Allocator::Impl::add_block(std::uint32_t type, VkDeviceSize bytes, bool image, bool dedicated,
                                  std::uint64_t& id) {
  // Software drivers promise more than the computer has: the heap's size is the limit.
  if (bytes > largest_allocation || taken_from_heap_of(type) + bytes > heap_size(type)) return nullptr;
  Block block;
  block.bytes = bytes;
  block.type = type;
  block.image = image;
  block.dedicated = dedicated;
  block.free[0] = bytes;
  VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  info.allocationSize = bytes;
  info.memoryTypeIndex = type;
  const VkResult result = vkAllocateMemory(device.handle(), &info, nullptr, &block.memory);
  if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY) return nullptr;
  check(result, "allocate memory");
  if ((flags(type) & kHost) == kHost) {
    void* mapped = nullptr;
    const VkResult answer = vkMapMemory(device.handle(), block.memory, 0, VK_WHOLE_SIZE, 0, &mapped);
    if (answer != VK_SUCCESS) vkFreeMemory(device.handle(), block.memory, nullptr);
    check(answer, "map memory");
    block.mapped = static_cast<std::byte*>(mapped);
  }
  id = next_block++;
  return &blocks.emplace(id, std::move(block)).first->second;
}

Allocator::Allocation Allocator::Impl::carve(std::uint64_t id, Block& block, VkDeviceSize offset,
                                             VkDeviceSize bytes) const {
  Allocation allocation;
  allocation.memory = block.memory;
  allocation.offset = offset;
  allocation.size = bytes;
  allocation.mapped = block.mapped != nullptr ? block.mapped + offset : nullptr;
  allocation.cached = (flags(block.type) & kCached) != 0;
  allocation.block = id;
  return allocation;
}

std::optional<Allocator::Allocation> Allocator::Impl::from_type(std::uint32_t type,
                                                                const VkMemoryRequirements& needs,
                                                                bool image) {
  for (auto& [id, block] : blocks) {
    if (block.type != type || block.image != image || block.dedicated) continue;
    if (const auto offset = block.take(needs.size, needs.alignment))
      return carve(id, block, *offset, needs.size);
  }
  const VkDeviceSize usual = next_block_bytes(type, image);
  std::uint64_t id = 0;
  Block* block = needs.size * 2 <= usual ? add_block(type, usual, image, false, id) : nullptr;
  if (block == nullptr) block = add_block(type, needs.size, image, true, id);
  if (block == nullptr) return std::nullopt;
  return carve(id, *block, block->take(needs.size, needs.alignment).value(), needs.size);
}

void Allocator::Impl::fail(const VkMemoryRequirements& needs, std::uint32_t type,
                           const std::string& name) const {
  throw error(
      Exit::no_device,
      "There is no memory on device \"{}\" for {}: it needs {} bytes ({:.1f} MiB), while {:.1f} MiB of "
      "{:.1f} MiB are in use by this program; lower the resolution, close other programs that use "
      "the device, or choose another --device",
      device.info().name, name, needs.size, mebibytes(needs.size), mebibytes(taken_from_heap_of(type)),
      mebibytes(heap_size(type)));
}

Allocator::Allocator(Device& device, bool force_staging)
    : impl_(std::make_unique<Impl>(device, force_staging)) {
  impl_->fail_after_bytes = environment_number("WEFT_FAIL_ALLOCATION_AFTER_BYTES");
  VkPhysicalDeviceVulkan11Properties v11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &v11};
  vkGetPhysicalDeviceProperties2(device.physical(), &properties);
  impl_->largest_allocation = v11.maxMemoryAllocationSize;
  vkGetPhysicalDeviceMemoryProperties(device.physical(), &impl_->properties);
}

Allocator::~Allocator() {
  for (auto& [id, block] : impl_->blocks) vkFreeMemory(impl_->device.handle(), block.memory, nullptr);
}

Allocator::Allocation Allocator::allocate(const VkMemoryRequirements& needs, Memory memory, bool image,
                                          const std::string& name) {
  const std::lock_guard lock(impl_->mutex);
  const auto types = impl_->types_for(needs.memoryTypeBits, memory, image);
  if (types.empty())
    throw error(Exit::no_device, "Device \"{}\" has no kind of memory that fits {}; choose another --device",
                impl_->device.info().name, name);
  if (impl_->fail_after_bytes && impl_->live_bytes + needs.size > *impl_->fail_after_bytes)
    impl_->fail(needs, types.front(), name);
  for (const std::uint32_t type : types) {
    auto allocation = impl_->from_type(type, needs, image);
    if (!allocation) continue;
    if (memory == Memory::device && impl_->force_staging) allocation->mapped = nullptr;
    impl_->live_bytes += needs.size;
    ++impl_->live_count;
    return *allocation;
  }
  impl_->fail(needs, types.front(), name);
}

void Allocator::release(const Allocation& allocation) {
  if (allocation.memory == VK_NULL_HANDLE) return;
  const std::lock_guard lock(impl_->mutex);
  const auto found = impl_->blocks.find(allocation.block);
  WEFT_ASSERT(found != impl_->blocks.end());
  Block& block = found->second;
  block.give_back(allocation.offset, allocation.size);
  impl_->live_bytes -= allocation.size;
  --impl_->live_count;
  if (block.live > 0) return;
  // The first block of its kind stays: alternating allocate and release must not reach the driver.
  if (!block.dedicated && block.bytes <= kFirstBlockBytes) return;
  vkFreeMemory(impl_->device.handle(), block.memory, nullptr);
  impl_->blocks.erase(found);
}

std::uint64_t Allocator::live_bytes() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->live_bytes;
}

std::uint64_t Allocator::live_count() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->live_count;
}

std::uint64_t Allocator::block_bytes() const {
  const std::lock_guard lock(impl_->mutex);
  std::uint64_t bytes = 0;
  for (const auto& [id, block] : impl_->blocks) bytes += block.bytes;
  return bytes;
}

std::uint64_t Allocator::block_count() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->blocks.size();
}

std::uint64_t Allocator::heap_bytes() const { return impl_->device.info().memory_bytes; }

}  // namespace weft::gpu
