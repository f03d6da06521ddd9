// SPIR-V: what is embedded at build time, compiling GLSL at run time, and reading a module's interface.
#pragma once
#include <vulkan/vulkan.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace weft::gpu {

/// Embedded module by its path below shaders/, for example "passes/integrate.comp".
/// When a shader folder is set (set_shader_dir), the source there is compiled with shaderc instead.
/// @throws Error(Exit::usage) with the compiler's file:line messages.
std::vector<std::uint32_t> load_spirv(std::string_view name);
void set_shader_dir(const std::filesystem::path& dir);  ///< empty: embedded modules
std::vector<std::string_view> embedded_shaders();

struct Binding {
  std::uint32_t set = 0, binding = 0;
  VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  bool reads = false, writes = false;
  std::uint32_t stride = 0;  ///< of the runtime array, 0 when none
};

/// A module's interface, from decorations (they survive optimisation; names do not).
struct Reflection {
  std::vector<Binding> bindings;  ///< ascending
  std::uint32_t local_size[3] = {1, 1, 1};
  std::uint32_t push_constant_bytes = 0;
  std::vector<std::uint32_t> constant_ids;  ///< specialization constants, ascending
};
/// @throws Error(Exit::internal) when the words are not a SPIR-V module.
Reflection reflect(std::span<const std::uint32_t> spirv);

}  // namespace weft::gpu
