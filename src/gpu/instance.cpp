// Creating the instance: layers, extensions, and where validation messages go.
#include "gpu/instance.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "core/error.h"
#include "gpu/log.h"

namespace weft::gpu {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

std::vector<VkExtensionProperties> extensions_of(const char* layer) {
  std::uint32_t count = 0;
  if (vkEnumerateInstanceExtensionProperties(layer, &count, nullptr) != VK_SUCCESS) return {};
  std::vector<VkExtensionProperties> found(count);
  if (vkEnumerateInstanceExtensionProperties(layer, &count, found.data()) < 0) return {};
  found.resize(count);
  return found;
}

bool contains(const std::vector<VkExtensionProperties>& list, const char* name) {
  return std::any_of(list.begin(), list.end(),
                     [&](const VkExtensionProperties& e) { return std::strcmp(e.extensionName, name) == 0; });
}

bool validation_layer_there() {
  std::uint32_t count = 0;
  if (vkEnumerateInstanceLayerProperties(&count, nullptr) != VK_SUCCESS) return false;
  std::vector<VkLayerProperties> layers(count);
  if (vkEnumerateInstanceLayerProperties(&count, layers.data()) < 0) return false;
  return std::any_of(layers.begin(), layers.begin() + count, [](const VkLayerProperties& layer) {
    return std::strcmp(layer.layerName, kValidationLayer) == 0;
  });
}

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                          VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  const std::string text = data->pMessage != nullptr ? data->pMessage : "(a message without text)";
  static_cast<MessageLog*>(user)->add(text);
  const bool is_error = (severity & VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT) != 0;
  log()->log(is_error ? spdlog::level::err : spdlog::level::warn, "Vulkan validation: {}", text);
  return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messenger_info(MessageLog& log) {
  VkDebugUtilsMessengerCreateInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
  info.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
  info.pfnUserCallback = on_message;
  info.pUserData = &log;
  return info;
}

/// The names to enable: what the caller needs, and debug utilities when there.
std::vector<const char*> wanted_extensions(const std::vector<const char*>& needed, bool validation,
                                           bool& debug_utils) {
  const auto there = extensions_of(nullptr);
  for (const char* name : needed) {
    if (!contains(there, name)) {
      throw error(Exit::no_device,
                  "The Vulkan loader lacks the instance extension {}, which the window needs; install the "
                  "device's Vulkan driver (Debian: mesa-vulkan-drivers), or use a command without a window",
                  name);
    }
  }
  std::vector<const char*> names = needed;
  debug_utils = contains(there, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  if (debug_utils) names.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  if (!validation) return names;
  const auto of_layer = extensions_of(kValidationLayer);
  if (!debug_utils && contains(of_layer, VK_EXT_DEBUG_UTILS_EXTENSION_NAME)) {
    names.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    debug_utils = true;
  }
  if (contains(of_layer, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME))
    names.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
  return names;
}

}  // namespace

void MessageLog::add(std::string text) {
  const std::lock_guard lock(mutex_);
  messages_.push_back(std::move(text));
}

std::vector<std::string> MessageLog::all() const {
  const std::lock_guard lock(mutex_);
  return messages_;
}

void MessageLog::clear() {
  const std::lock_guard lock(mutex_);
  messages_.clear();
}

Instance::Instance(bool validation, const std::vector<const char*>& extensions) {
  if (validation && !validation_layer_there()) {
    throw error(Exit::no_device,
                "Validation was asked for, but the layer {} is not installed; install the package "
                "vulkan-validationlayers (Debian, Ubuntu) or vulkan-validation-layers (Fedora, Arch)",
                kValidationLayer);
  }
  const auto names = wanted_extensions(extensions, validation, debug_utils_);

  const VkApplicationInfo application{
      VK_STRUCTURE_TYPE_APPLICATION_INFO, nullptr, "weft", 1, "weft", 1, VK_API_VERSION_1_3};
  const VkValidationFeatureEnableEXT enabled = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
  auto messenger = messenger_info(messages_);
  VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
  features.enabledValidationFeatureCount = 1;
  features.pEnabledValidationFeatures = &enabled;
  features.pNext = debug_utils_ ? &messenger : nullptr;

  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  info.pApplicationInfo = &application;
  info.enabledExtensionCount = static_cast<std::uint32_t>(names.size());
  info.ppEnabledExtensionNames = names.data();
  if (validation) {
    info.pNext = &features;
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = &kValidationLayer;
  }
  check(vkCreateInstance(&info, nullptr, &handle_), "create a Vulkan instance");
  if (validation && debug_utils_) create_messenger(messenger);
}

void Instance::create_messenger(const VkDebugUtilsMessengerCreateInfoEXT& info) {
  const auto create = function<PFN_vkCreateDebugUtilsMessengerEXT>("vkCreateDebugUtilsMessengerEXT");
  const VkResult result = create(handle_, &info, nullptr, &messenger_);
  if (result != VK_SUCCESS) {
    vkDestroyInstance(handle_, nullptr);
    check(result, "listen to validation messages");
  }
}

Instance::~Instance() {
  if (messenger_ != VK_NULL_HANDLE)
    function<PFN_vkDestroyDebugUtilsMessengerEXT>("vkDestroyDebugUtilsMessengerEXT")(handle_, messenger_,
                                                                                     nullptr);
  vkDestroyInstance(handle_, nullptr);
}

}  // namespace weft::gpu
