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

/// Embedded module by its path below shaders/, for example "passes/integrate.comp"; a variant compiled with a
/// macro defined is "passes/integrate.comp+MACRO".
/// When a shader folder is set (set_shader_dir), the source there is compiled with shaderc instead.
/// @throws Error(Exit::usage) with the compiler's file:line messages.
std::vector<std::uint32_t> load_spirv(std::string_view name);
bool has_spirv(std::string_view name);                  ///< whether load_spirv would find it
void set_shader_dir(const std::filesystem::path& dir);  ///< empty: embedded modules
std::vector<std::string_view> embedded_shaders();

/// Compiles GLSL as the build does (Vulkan 1.3, optimised, warnings are errors). The stage follows from the
/// file's ending (.comp, .vert, .frag); #include is relative to the including file.
/// @throws Error(Exit::usage) with the compiler's file:line messages; Exit::io when it cannot be read.
std::vector<std::uint32_t> compile_glsl(const std::filesystem::path& file);
/// The same for a text in memory; `file` stands for where it would lie.
std::vector<std::uint32_t> compile_glsl_text(std::string_view text, const std::filesystem::path& file);

struct Binding {
  std::uint32_t set = 0, binding = 0;
  std::uint32_t count = 1;  ///< of an array of descriptors
  VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  bool reads = false, writes = false;
  std::uint32_t stride = 0;  ///< of the runtime array, 0 when none
};

/// A module's interface, from decorations (they survive optimisation; names do not).
struct Reflection {
  std::vector<Binding> bindings;            ///< ascending by set, then binding
  std::uint32_t local_size[3] = {1, 1, 1};  // NOLINT(modernize-avoid-c-arrays): passed on as a pointer
  std::uint32_t push_constant_bytes = 0;
  std::vector<std::uint32_t> constant_ids;  ///< specialization constants, ascending
};
/// @param constants  specialization constants, id = place in the list; they may decide the local size
/// @throws Error(Exit::internal) when the words are not a SPIR-V module.
Reflection reflect(std::span<const std::uint32_t> spirv, std::span<const std::uint32_t> constants = {});

}  // namespace weft::gpu
