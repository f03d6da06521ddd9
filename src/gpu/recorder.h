// Records labelled dispatches; barriers follow from what each pipeline reads and writes.
#pragma once
#include <vulkan/vulkan.h>

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "gpu/pipeline.h"

namespace weft::gpu {

/// Whether a recorder inserts barriers. `none` exists to prove that the validation layer sees their lack.
enum class Barriers { automatic, none };

class Recorder {
 public:
  /// Assumes nothing of earlier command buffers: begins with a barrier against all their writes.
  Recorder(Device&, VkCommandBuffer, Barriers barriers = Barriers::automatic);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;
  void label(std::string_view text);  ///< opens a debug label; closed by end_label or the destructor
  void end_label();
  /// Binds, inserts the barriers needed since the latest use of each buffer, dispatches. The pipeline, the
  /// set and its buffers must outlive the command buffer.
  /// @param push_constants  as many bytes as the shader declares
  void dispatch(const ComputePipeline&, const DescriptorSet&, std::uint32_t groups_x, std::uint32_t groups_y,
                std::span<const std::byte> push_constants = {});
  /// The same with the workgroups (x, y, z) in a buffer, read when the device comes to it.
  /// @param offset  of the first of the three words [bytes], a multiple of 4
  void dispatch_indirect(const ComputePipeline&, const DescriptorSet&, const Buffer& groups,
                         VkDeviceSize offset, std::span<const std::byte> push_constants = {});
  /// Makes all shader writes so far visible to index and vertex input, vertex shaders, transfers and the
  /// host.
  void finish();
  std::uint64_t dispatch_count() const { return dispatches_; }
  std::uint64_t barrier_count() const { return barrier_count_; }  ///< between dispatches

 private:
  struct Use {
    VkBuffer buffer;
    bool read, written;
  };
  bool conflicts(const ComputePipeline&, const DescriptorSet&) const;
  void note_uses(const ComputePipeline&, const DescriptorSet&);
  void bind(const ComputePipeline&, const DescriptorSet&);
  void order(const ComputePipeline&, const DescriptorSet&, bool indirect);
  void push(const ComputePipeline&, std::span<const std::byte> push_constants);
  Device& device_;
  VkCommandBuffer commands_;
  Barriers barriers_;
  VkPipeline bound_ = VK_NULL_HANDLE;
  VkDescriptorSet bound_set_ = VK_NULL_HANDLE;
  std::vector<Use> uses_;
  std::uint64_t dispatches_ = 0;
  std::uint64_t barrier_count_ = 0;
  bool indirect_ = false;  // whether the device read workgroups since the latest barrier
  int labels_ = 0;
};

/// Timestamps on the device; empty answers where the device has none.
class Timer {
 public:
  Timer(Device&, std::uint32_t slots);
  ~Timer();
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;
  bool available() const { return pool_ != VK_NULL_HANDLE; }
  void reset(VkCommandBuffer);  ///< all slots; before they are stamped again
  /// The time when all commands recorded before are finished.
  void stamp(VkCommandBuffer, std::uint32_t slot);
  /// Milliseconds between two slots, once their work is finished; negative when not available.
  double between_ms(std::uint32_t first, std::uint32_t second) const;

 private:
  Device& device_;
  VkQueryPool pool_ = VK_NULL_HANDLE;
  std::uint32_t slots_;
};

}  // namespace weft::gpu
