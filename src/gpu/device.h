// A Vulkan 1.3 device: choosing it by rank or name, its queue, its limits, its validation messages.
// Nothing here knows of cloth.
#pragma once
#include <vulkan/vulkan.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace weft::gpu {

class Allocator;
class PipelineCache;

struct DeviceInfo {
  std::uint32_t index = 0;  ///< place in the ranked list
  std::string name, driver, uuid, api_version;
  VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
  bool software = false;
  bool float64 = false;
  bool timestamps = false;
  bool wireframe = false;  ///< fillModeNonSolid
  bool wide_lines = false;
  bool anisotropy = false;  ///< samplerAnisotropy
  std::uint32_t subgroup_size = 0;
  bool subgroup_ballot = false;  ///< elections and ballots in compute shaders
  std::uint64_t memory_bytes = 0;
  std::string unusable;  ///< why it cannot run Weft; empty when it can
  /// "llvmpipe (software)": the name, and plainly said when it is no GPU.
  std::string label() const { return software ? name + " (software)" : name; }
};

/// Every Vulkan device there is, ranked discrete, integrated, virtual, software; unusable ones last.
/// Without a Vulkan loader or driver the list is empty.
std::vector<DeviceInfo> list_devices();

/// Looks whether `choice` means a device, as DeviceOptions::choice does, without opening it.
/// @throws Error(Exit::no_device) naming those there are
void require_device(const std::string& choice);

/// Why `device` cannot compute in double, for an error message: it has no float64, and those of `all` that
/// have.
std::string no_float64(const DeviceInfo& device, std::span<const DeviceInfo> all);

struct DeviceOptions {
  std::string choice;       ///< part of the name, index in list_devices(), or UUID; empty: the first usable
  bool validation = false;  ///< core and synchronization validation; every message is counted
  bool force_staging = false;  ///< pretend no device memory is host visible (also WEFT_FORCE_STAGING=1)
  std::vector<const char*> instance_extensions, device_extensions;  ///< for a window
};

/// What a submission waits for and signals besides the timeline: a window's swapchain.
struct SubmitSemaphores {
  VkSemaphore wait = VK_NULL_HANDLE;
  VkPipelineStageFlags2 wait_stage = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
  VkSemaphore signal = VK_NULL_HANDLE;
};

/// One device with one queue. Any thread may make, fill and free buffers, pipelines and commands of its own
/// and submit them; what it made, one thread at a time uses.
///
/// Every optional feature that DeviceInfo reports is enabled when it is there. Debug switches in the
/// environment: WEFT_FORCE_STAGING=1; WEFT_WITHOUT_FLOAT64=1 lets every device lack float64;
/// WEFT_FAIL_ALLOCATION_AFTER_BYTES=n lets allocation n+1 fail as if memory were out;
/// WEFT_SIMULATE_DEVICE_LOSS_AFTER=n lets submission n+1 fail as if the device were lost.
class Device {
 public:
  /// @throws Error(Exit::no_device) naming the devices there are and why each will not do.
  explicit Device(const DeviceOptions&);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  const DeviceInfo& info() const;
  VkInstance instance() const;
  VkPhysicalDevice physical() const;
  VkDevice handle() const;
  VkQueue queue() const;
  std::uint32_t queue_family() const;
  const VkPhysicalDeviceLimits& limits() const;
  std::uint64_t buffer_bytes_max() const;  ///< of any one buffer (maxBufferSize)
  Allocator& allocator();
  PipelineCache& pipeline_cache();

  /// Messages of the validation layer so far (errors and warnings); tests require none.
  std::vector<std::string> validation_messages() const;
  void clear_validation_messages();  ///< for a test that provokes one
  bool validating() const;

  /// Records and submits once, and waits: uploads, read-backs, tests. Ordered after everything submitted
  /// before and before everything after, for all stages and the host.
  void run_once(const std::function<void(VkCommandBuffer)>& record);
  /// Submits, signalling the device's timeline; returns the value that `wait` takes.
  std::uint64_t submit(VkCommandBuffer commands);
  /// Several command buffers in one submission, in this order.
  std::uint64_t submit(std::span<const VkCommandBuffer> commands, const SubmitSemaphores& semaphores = {});
  /// Hands a picture over to be shown. Returns what vkQueuePresentKHR says, with no error thrown.
  VkResult present(const VkPresentInfoKHR&);
  void wait(std::uint64_t value);
  /// Waits so long at most [s]; negative: as long as it takes. Returns whether the device has come that far.
  bool wait_for(std::uint64_t value, double wait_s);
  std::uint64_t completed();        ///< latest finished timeline value
  std::uint64_t submitted() const;  ///< latest timeline value handed out
  void wait_idle();  ///< for all that was submitted, and for semaphores that a picture waits on

  /// Names an object for RenderDoc and validation messages.
  void name(VkObjectType type, std::uint64_t handle, const std::string& text);
  /// Names any Vulkan handle, dispatchable or not.
  template <class Handle>
  void name(VkObjectType type, Handle* handle, const std::string& text) {
    name(type, reinterpret_cast<std::uint64_t>(handle), text);
  }
  /// Debug labels around commands; nothing when the loader has no VK_EXT_debug_utils.
  void begin_label(VkCommandBuffer, const std::string& text) const;
  void end_label(VkCommandBuffer) const;
  VkSemaphore timeline() const;
  double timestamp_ns() const;  ///< nanoseconds a timestamp tick; 0 when there are none
  std::uint32_t timestamp_valid_bits() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// @throws Error naming the wish and Vulkan's answer; out of memory and device loss are Exit::no_device.
void check(VkResult result, const char* wish);

}  // namespace weft::gpu
