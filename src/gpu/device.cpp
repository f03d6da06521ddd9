// The logical device: features, queue, timeline, submission.
#include "gpu/device.h"

#include <array>
#include <cstring>
#include <mutex>
#include <optional>

#include "core/environment.h"
#include "core/error.h"
#include "gpu/buffer.h"
#include "gpu/commands.h"
#include "gpu/instance.h"
#include "gpu/pipeline.h"

namespace weft::gpu {

struct Device::Impl {
  Impl(const DeviceOptions& options)
      : instance(options.validation, options.instance_extensions), validating(options.validation) {}
  ~Impl();

  Instance instance;
  bool validating;
  Candidate chosen;
  VkPhysicalDeviceLimits limits{};
  std::uint64_t buffer_bytes_max = 0;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  VkSemaphore timeline = VK_NULL_HANDLE;
  std::uint32_t timestamp_bits = 0;
  mutable std::mutex submitting, making_cache;
  std::uint64_t submitted = 0;
  std::uint64_t submissions = 0;
  std::optional<std::uint64_t> loss_after;
  std::unique_ptr<Allocator> allocator;
  std::unique_ptr<PipelineCache> cache;
  PFN_vkSetDebugUtilsObjectNameEXT set_name = nullptr;
  PFN_vkCmdBeginDebugUtilsLabelEXT begin_label = nullptr;
  PFN_vkCmdEndDebugUtilsLabelEXT end_label = nullptr;

  void create_device(const std::vector<const char*>& extensions);
  void create_timeline();
  void load_debug_functions();
};

Device::Impl::~Impl() {
  if (device == VK_NULL_HANDLE) return;
  vkDestroySemaphore(device, timeline, nullptr);
  vkDestroyDevice(device, nullptr);
}

namespace {

/// Exactly the features Weft needs, and the optional ones that DeviceInfo reports.
struct Features {
  VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
  VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &v13};
  VkPhysicalDeviceFeatures2 all{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &v12};

  explicit Features(const DeviceInfo& info) {
    v12.timelineSemaphore = VK_TRUE;
    v12.scalarBlockLayout = VK_TRUE;
    v13.synchronization2 = VK_TRUE;
    v13.dynamicRendering = VK_TRUE;
    v13.maintenance4 = VK_TRUE;  // LocalSizeId, which SPIR-V 1.6 uses for specialised workgroup sizes
    all.features.shaderFloat64 = info.float64 ? VK_TRUE : VK_FALSE;
    all.features.fillModeNonSolid = info.wireframe ? VK_TRUE : VK_FALSE;
    all.features.wideLines = info.wide_lines ? VK_TRUE : VK_FALSE;
    all.features.samplerAnisotropy = info.anisotropy ? VK_TRUE : VK_FALSE;
  }
  Features(const Features&) = delete;
  Features& operator=(const Features&) = delete;
};

void require_device_extensions(const Candidate& chosen, const std::vector<const char*>& wanted) {
  std::uint32_t count = 0;
  check(vkEnumerateDeviceExtensionProperties(chosen.physical, nullptr, &count, nullptr), "list extensions");
  std::vector<VkExtensionProperties> there(count);
  check(vkEnumerateDeviceExtensionProperties(chosen.physical, nullptr, &count, there.data()),
        "list extensions");
  for (const char* name : wanted) {
    bool found = false;
    for (const auto& e : there) found = found || std::strcmp(e.extensionName, name) == 0;
    if (!found) {
      throw error(Exit::no_device,
                  "Device \"{}\" lacks the extension {}, which the window needs; choose another --device, or "
                  "use a command without a window",
                  chosen.info.name, name);
    }
  }
}

/// Everything before against everything after: what surrounds a run_once.
void full_barrier(VkCommandBuffer commands, VkPipelineStageFlags2 also = 0, VkAccessFlags2 access = 0) {
  VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
  barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | also;
  barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT | access;
  VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  dependency.memoryBarrierCount = 1;
  dependency.pMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &dependency);
}

}  // namespace

void Device::Impl::create_device(const std::vector<const char*>& extensions) {
  require_device_extensions(chosen, extensions);
  const Features features(chosen.info);
  const float priority = 1.0f;
  VkDeviceQueueCreateInfo queue_info{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queue_info.queueFamilyIndex = chosen.queue_family;
  queue_info.queueCount = 1;
  queue_info.pQueuePriorities = &priority;
  VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features.all};
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue_info;
  info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  check(vkCreateDevice(chosen.physical, &info, nullptr, &device), "open the Vulkan device");
  vkGetDeviceQueue(device, chosen.queue_family, 0, &queue);

  VkPhysicalDeviceVulkan13Properties v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &v13};
  vkGetPhysicalDeviceProperties2(chosen.physical, &properties);
  limits = properties.properties.limits;
  buffer_bytes_max = v13.maxBufferSize;
  std::uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(chosen.physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(chosen.physical, &count, families.data());
  timestamp_bits = chosen.info.timestamps ? families.at(chosen.queue_family).timestampValidBits : 0;
}

void Device::Impl::create_timeline() {
  VkSemaphoreTypeCreateInfo type{VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO};
  type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
  const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, &type, 0};
  check(vkCreateSemaphore(device, &info, nullptr, &timeline), "create the timeline semaphore");
}

void Device::Impl::load_debug_functions() {
  if (!instance.debug_utils()) return;
  set_name = instance.function<PFN_vkSetDebugUtilsObjectNameEXT>("vkSetDebugUtilsObjectNameEXT");
  begin_label = instance.function<PFN_vkCmdBeginDebugUtilsLabelEXT>("vkCmdBeginDebugUtilsLabelEXT");
  end_label = instance.function<PFN_vkCmdEndDebugUtilsLabelEXT>("vkCmdEndDebugUtilsLabelEXT");
}

Device::Device(const DeviceOptions& options) : impl_(std::make_unique<Impl>(options)) {
  impl_->chosen = choose_device(ranked_devices(impl_->instance.handle()), options.choice);
  impl_->create_device(options.device_extensions);
  impl_->load_debug_functions();
  impl_->create_timeline();
  impl_->loss_after = environment_number("WEFT_SIMULATE_DEVICE_LOSS_AFTER");
  const bool staging = options.force_staging || environment_number("WEFT_FORCE_STAGING").value_or(0) != 0;
  impl_->allocator = std::make_unique<Allocator>(*this, staging);
}

Device::~Device() {
  vkDeviceWaitIdle(impl_->device);  // a lost device answers at once; there is nothing else left to do
  impl_->cache.reset();
  impl_->allocator.reset();
}

const DeviceInfo& Device::info() const { return impl_->chosen.info; }
VkInstance Device::instance() const { return impl_->instance.handle(); }
VkPhysicalDevice Device::physical() const { return impl_->chosen.physical; }
VkDevice Device::handle() const { return impl_->device; }
VkQueue Device::queue() const { return impl_->queue; }
std::uint32_t Device::queue_family() const { return impl_->chosen.queue_family; }
const VkPhysicalDeviceLimits& Device::limits() const { return impl_->limits; }
std::uint64_t Device::buffer_bytes_max() const { return impl_->buffer_bytes_max; }
Allocator& Device::allocator() { return *impl_->allocator; }
VkSemaphore Device::timeline() const { return impl_->timeline; }
std::uint64_t Device::submitted() const {
  const std::lock_guard lock(impl_->submitting);
  return impl_->submitted;
}
bool Device::validating() const { return impl_->validating; }
std::uint32_t Device::timestamp_valid_bits() const { return impl_->timestamp_bits; }
double Device::timestamp_ns() const {
  return impl_->timestamp_bits > 0 ? double{impl_->limits.timestampPeriod} : 0.0;
}

PipelineCache& Device::pipeline_cache() {
  const std::lock_guard lock(impl_->making_cache);
  if (!impl_->cache) impl_->cache = std::make_unique<PipelineCache>(*this);
  return *impl_->cache;
}

std::vector<std::string> Device::validation_messages() const { return impl_->instance.messages().all(); }
void Device::clear_validation_messages() { impl_->instance.messages().clear(); }

void Device::run_once(const std::function<void(VkCommandBuffer)>& record) {
  Commands commands(*this, "run once");
  commands.record([&](VkCommandBuffer handle) {
    full_barrier(handle);
    record(handle);
    full_barrier(handle, VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
  });
  wait(submit(commands.handle()));
}

std::uint64_t Device::submit(VkCommandBuffer commands) { return submit({&commands, 1}); }

std::uint64_t Device::submit(std::span<const VkCommandBuffer> commands, const SubmitSemaphores& semaphores) {
  const std::lock_guard lock(impl_->submitting);
  if (impl_->loss_after && impl_->submissions >= *impl_->loss_after)
    check(VK_ERROR_DEVICE_LOST, "submit work (WEFT_SIMULATE_DEVICE_LOSS_AFTER)");
  std::vector<VkCommandBufferSubmitInfo> buffers;
  for (VkCommandBuffer handle : commands)
    buffers.push_back({VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO, nullptr, handle, 0});

  const auto semaphore = [](VkSemaphore handle, std::uint64_t value, VkPipelineStageFlags2 stage) {
    return VkSemaphoreSubmitInfo{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO, nullptr, handle, value, stage, 0};
  };
  const auto wait_info = semaphore(semaphores.wait, 0, semaphores.wait_stage);
  const std::array signals = {
      semaphore(impl_->timeline, impl_->submitted + 1, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT),
      semaphore(semaphores.signal, 0, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT)};
  VkSubmitInfo2 info{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
  info.waitSemaphoreInfoCount = semaphores.wait != VK_NULL_HANDLE ? 1 : 0;
  info.pWaitSemaphoreInfos = &wait_info;
  info.commandBufferInfoCount = static_cast<std::uint32_t>(buffers.size());
  info.pCommandBufferInfos = buffers.data();
  info.signalSemaphoreInfoCount = semaphores.signal != VK_NULL_HANDLE ? 2 : 1;
  info.pSignalSemaphoreInfos = signals.data();
  check(vkQueueSubmit2(impl_->queue, 1, &info, VK_NULL_HANDLE), "submit work");
  ++impl_->submissions;
  return ++impl_->submitted;
}

VkResult Device::present(const VkPresentInfoKHR& info) {
  const std::lock_guard lock(impl_->submitting);
  return vkQueuePresentKHR(impl_->queue, &info);
}

void Device::wait(std::uint64_t value) { wait_for(value, -1.0); }

bool Device::wait_for(std::uint64_t value, double wait_s) {
  VkSemaphoreWaitInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO};
  info.semaphoreCount = 1;
  info.pSemaphores = &impl_->timeline;
  info.pValues = &value;
  const std::uint64_t patience_ns = wait_s < 0.0 ? UINT64_MAX : static_cast<std::uint64_t>(1e9 * wait_s);
  const VkResult result = vkWaitSemaphores(impl_->device, &info, patience_ns);
  if (result == VK_TIMEOUT) return false;
  check(result, "wait for the device");
  return true;
}

std::uint64_t Device::completed() {
  std::uint64_t value = 0;
  check(vkGetSemaphoreCounterValue(impl_->device, impl_->timeline, &value), "ask how far the device is");
  return value;
}

void Device::wait_idle() {
  wait(submitted());
  // The timeline knows nothing of pictures handed over to be shown: their semaphores are waited for after it.
  const std::lock_guard lock(impl_->submitting);
  check(vkQueueWaitIdle(impl_->queue), "wait for the device's queue");
}

void Device::name(VkObjectType type, std::uint64_t handle, const std::string& text) {
  if (impl_->set_name == nullptr) return;
  VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
  info.objectType = type;
  info.objectHandle = handle;
  info.pObjectName = text.c_str();
  check(impl_->set_name(impl_->device, &info), "name an object");
}

void Device::begin_label(VkCommandBuffer commands, const std::string& text) const {
  if (impl_->begin_label == nullptr) return;
  VkDebugUtilsLabelEXT label{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT};
  label.pLabelName = text.c_str();
  impl_->begin_label(commands, &label);
}

void Device::end_label(VkCommandBuffer commands) const {
  if (impl_->end_label != nullptr) impl_->end_label(commands);
}

}  // namespace weft::gpu
