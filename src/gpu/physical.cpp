// Which Vulkan devices there are, whether each can run Weft, their rank, and the one a choice means.
#include <algorithm>
#include <cctype>
#include <cstring>
#include <optional>

#include "core/environment.h"
#include "core/error.h"
#include "core/text.h"
#include "gpu/instance.h"

namespace weft::gpu {
namespace {

std::string version_text(std::uint32_t version) {
  return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
                     VK_API_VERSION_PATCH(version));
}

std::string uuid_text(const std::uint8_t* uuid) {
  std::string text;
  for (std::size_t i = 0; i < VK_UUID_SIZE; ++i) {
    if (i == 4 || i == 6 || i == 8 || i == 10) text += '-';
    text += fmt::format("{:02x}", uuid[i]);
  }
  return text;
}

std::optional<std::uint32_t> find_queue_family(VkPhysicalDevice physical, bool& timestamps) {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
  constexpr VkQueueFlags kNeeded = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
  for (std::uint32_t f = 0; f < count; ++f) {
    if ((families[f].queueFlags & kNeeded) != kNeeded) continue;
    timestamps = families[f].timestampValidBits > 0;
    return f;
  }
  return std::nullopt;
}

std::uint64_t largest_local_heap(VkPhysicalDevice physical) {
  VkPhysicalDeviceMemoryProperties memory;
  vkGetPhysicalDeviceMemoryProperties(physical, &memory);
  std::uint64_t bytes = 0;
  for (std::uint32_t h = 0; h < memory.memoryHeapCount; ++h)
    if ((memory.memoryHeaps[h].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0)
      bytes = std::max(bytes, std::uint64_t{memory.memoryHeaps[h].size});
  return bytes;
}

/// Fills in what only a Vulkan 1.3 device can be asked; returns what it lacks.
std::string examine_features(VkPhysicalDevice physical, DeviceInfo& info) {
  VkPhysicalDeviceVulkan12Properties properties12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES};
  VkPhysicalDeviceVulkan11Properties properties11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES,
                                                  &properties12};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &properties11};
  vkGetPhysicalDeviceProperties2(physical, &properties);
  info.driver = fmt::format("{} {}", properties12.driverName, properties12.driverInfo);
  info.uuid = uuid_text(properties11.deviceUUID);

  VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
  VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &v13};
  VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &v12};
  vkGetPhysicalDeviceFeatures2(physical, &features);
  info.float64 = features.features.shaderFloat64 != VK_FALSE &&
                 environment_number("WEFT_WITHOUT_FLOAT64").value_or(0) == 0;
  info.wireframe = features.features.fillModeNonSolid != VK_FALSE;
  info.wide_lines = features.features.wideLines != VK_FALSE;
  info.anisotropy = features.features.samplerAnisotropy != VK_FALSE;

  std::string lacks;
  const auto need = [&](VkBool32 there, const char* name) {
    if (there == VK_FALSE) lacks += (lacks.empty() ? "" : ", ") + std::string(name);
  };
  need(v12.timelineSemaphore, "timelineSemaphore");
  need(v12.scalarBlockLayout, "scalarBlockLayout");
  need(v13.synchronization2, "synchronization2");
  need(v13.dynamicRendering, "dynamicRendering");
  need(v13.maintenance4, "maintenance4");
  return lacks.empty() ? "" : "its driver lacks " + lacks;
}

void examine_subgroups(VkPhysicalDevice physical, DeviceInfo& info) {
  VkPhysicalDeviceSubgroupProperties subgroups{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &subgroups};
  vkGetPhysicalDeviceProperties2(physical, &properties);
  constexpr VkSubgroupFeatureFlags kWanted = VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_BALLOT_BIT;
  info.subgroup_size = subgroups.subgroupSize;
  info.subgroup_ballot = (subgroups.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0 &&
                         (subgroups.supportedOperations & kWanted) == kWanted;
}

Candidate examine(VkPhysicalDevice physical) {
  VkPhysicalDeviceProperties properties;
  vkGetPhysicalDeviceProperties(physical, &properties);
  Candidate candidate;
  candidate.physical = physical;
  DeviceInfo& info = candidate.info;
  info.name = properties.deviceName;
  info.api_version = version_text(properties.apiVersion);
  info.type = properties.deviceType;
  info.software = properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
  info.memory_bytes = largest_local_heap(physical);
  const auto family = find_queue_family(physical, info.timestamps);
  candidate.queue_family = family.value_or(0);
  info.timestamps = info.timestamps && properties.limits.timestampPeriod > 0.0f;
  if (properties.apiVersion < VK_API_VERSION_1_3)
    info.unusable = fmt::format("its driver offers Vulkan {}; 1.3 is needed", info.api_version);
  else
    info.unusable = examine_features(physical, info);
  if (info.unusable.empty()) examine_subgroups(physical, info);
  if (info.unusable.empty() && !family) info.unusable = "none of its queues can do both graphics and compute";
  return candidate;
}

int rank(const DeviceInfo& info) {
  const int unusable = info.unusable.empty() ? 0 : 10;
  switch (info.type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return unusable;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return unusable + 1;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return unusable + 2;
    case VK_PHYSICAL_DEVICE_TYPE_CPU: return unusable + 4;
    default: return unusable + 3;
  }
}

bool is_number(const std::string& text) {
  return !text.empty() && text.size() < 5 &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

bool means(const std::string& choice, const DeviceInfo& info) {
  if (is_number(choice)) return info.index == std::stoul(choice);
  return in_lower_case(info.uuid) == in_lower_case(choice) ||
         in_lower_case(info.name).find(in_lower_case(choice)) != std::string::npos;
}

std::string table(const std::vector<Candidate>& candidates) {
  std::string text;
  for (const Candidate& c : candidates)
    text += fmt::format("\n  {}  {}: {}", c.info.index, c.info.name,
                        c.info.unusable.empty() ? "usable" : "unusable, " + c.info.unusable);
  return text;
}

}  // namespace

std::vector<Candidate> ranked_devices(VkInstance instance) {
  std::uint32_t count = 0;
  if (vkEnumeratePhysicalDevices(instance, &count, nullptr) != VK_SUCCESS) return {};
  std::vector<VkPhysicalDevice> physical(count);
  if (vkEnumeratePhysicalDevices(instance, &count, physical.data()) < 0) return {};
  physical.resize(count);
  std::vector<Candidate> candidates;
  candidates.reserve(physical.size());
  for (VkPhysicalDevice p : physical) candidates.push_back(examine(p));
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return rank(a.info) < rank(b.info); });
  for (std::uint32_t i = 0; i < candidates.size(); ++i) candidates[i].info.index = i;
  return candidates;
}

Candidate choose_device(const std::vector<Candidate>& candidates, const std::string& choice) {
  if (candidates.empty()) {
    throw error(Exit::no_device,
                "There is no Vulkan device; install a driver (Debian: mesa-vulkan-drivers, which also brings "
                "a software device), or compute without one (weft simulate --device native)");
  }
  const Candidate* refused = nullptr;
  for (const Candidate& c : candidates) {
    if (!choice.empty() && !means(choice, c.info)) continue;
    if (c.info.unusable.empty()) return c;
    if (refused == nullptr) refused = &c;
  }
  if (choice.empty()) {
    throw error(Exit::no_device,
                "No Vulkan device can run Weft; update its driver, or compute without one (weft simulate "
                "--device native):{}",
                table(candidates));
  }
  if (refused != nullptr)
    throw error(Exit::no_device, "Device \"{}\" is {}, which cannot run Weft: {}; choose one of:{}", choice,
                refused->info.name, refused->info.unusable, table(candidates));
  throw error(
      Exit::no_device,
      "--device is \"{}\"; it must be cpu or native (without Vulkan), or part of a name, an index or a UUID "
      "of:{}",
      choice, table(candidates));
}

std::vector<DeviceInfo> list_devices() {
  std::vector<DeviceInfo> infos;
  try {
    const Instance instance(false, {});
    for (Candidate& c : ranked_devices(instance.handle())) infos.push_back(std::move(c.info));
  } catch (const Error&) {
    // No driver at all: an empty list is the answer.
  }
  return infos;
}

void require_device(const std::string& choice) {
  const Instance instance(false, {});
  choose_device(ranked_devices(instance.handle()), choice);
}

std::string no_float64(const DeviceInfo& device, std::span<const DeviceInfo> all) {
  std::string able;
  for (const DeviceInfo& info : all)
    if (info.float64 && info.unusable.empty()) able += (able.empty() ? "" : ", ") + info.name;
  return fmt::format("{} has no float64; {}", device.name,
                     able.empty() ? "no device here has it" : "these have it: " + able);
}

}  // namespace weft::gpu
