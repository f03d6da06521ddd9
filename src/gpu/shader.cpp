// Where SPIR-V comes from: embedded at build time, or GLSL compiled by shaderc at run time.
#include "gpu/shader.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <memory>
#include <mutex>
#include <shaderc/shaderc.hpp>

#include "core/error.h"
#include "embedded_spirv.h"

namespace weft::gpu {
namespace {

/// The folder that replaces the embedded modules; shared by every thread that loads shaders.
struct ShaderDir {
  std::mutex mutex;
  std::filesystem::path path;
};

ShaderDir& shader_dir() {
  static ShaderDir dir;
  return dir;
}

std::string read_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw error(Exit::io, "The shader {} cannot be read; check the shader folder", file.string());
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Finds an include beside the file that includes it, as glslc does.
class Includer : public shaderc::CompileOptions::IncluderInterface {
 public:
  shaderc_include_result* GetInclude(const char* requested, shaderc_include_type, const char* requesting,
                                     std::size_t) override {
    auto found = std::make_unique<Found>();
    const auto file = (std::filesystem::path(requesting).parent_path() / requested).lexically_normal();
    try {
      found->text = read_text(file);
      found->name = file.string();
    } catch (const Error& problem) {
      found->text = problem.what();  // an empty name tells shaderc that the text is an error
    }
    found->result = {found->name.c_str(), found->name.size(), found->text.c_str(), found->text.size(),
                     found.get()};
    return &found.release()->result;
  }
  void ReleaseInclude(shaderc_include_result* result) override {
    delete static_cast<Found*>(result->user_data);
  }

 private:
  struct Found {
    std::string name, text;
    shaderc_include_result result{};
  };
};

shaderc_shader_kind stage_of(const std::filesystem::path& file) {
  const auto ending = file.extension();
  if (ending == ".comp") return shaderc_compute_shader;
  if (ending == ".vert") return shaderc_vertex_shader;
  if (ending == ".frag") return shaderc_fragment_shader;
  throw error(Exit::usage, "{}: a shader's name must end in .comp, .vert or .frag", file.string());
}

std::vector<std::uint32_t> compile(std::string_view text, const std::filesystem::path& file,
                                   std::string_view macros) {
  shaderc::CompileOptions options;
  options.SetTargetEnvironment(shaderc_target_env_vulkan, shaderc_env_version_vulkan_1_3);
  options.SetOptimizationLevel(shaderc_optimization_level_performance);
  options.SetWarningsAsErrors();
  options.SetIncluder(std::make_unique<Includer>());
  while (!macros.empty()) {
    const std::size_t plus = std::min(macros.find('+'), macros.size());
    options.AddMacroDefinition(std::string(macros.substr(0, plus)));
    macros.remove_prefix(std::min(plus + 1, macros.size()));
  }
  const shaderc::Compiler compiler;
  const auto result =
      compiler.CompileGlslToSpv(text.data(), text.size(), stage_of(file), file.string().c_str(), options);
  if (result.GetCompilationStatus() != shaderc_compilation_status_success)
    throw error(Exit::usage, "The shader does not compile; correct it:\n{}", result.GetErrorMessage());
  return {result.cbegin(), result.cend()};
}

}  // namespace

std::vector<std::uint32_t> compile_glsl_text(std::string_view text, const std::filesystem::path& file) {
  return compile(text, file, "");
}

std::vector<std::uint32_t> compile_glsl(const std::filesystem::path& file) {
  return compile_glsl_text(read_text(file), file);
}

void set_shader_dir(const std::filesystem::path& dir) {
  if (!dir.empty() && !std::filesystem::is_directory(dir))
    throw error(Exit::usage, "The shader folder {} is not a folder", dir.string());
  const std::lock_guard lock(shader_dir().mutex);
  shader_dir().path = dir;
}

std::vector<std::uint32_t> load_spirv(std::string_view name) {
  std::filesystem::path dir;
  {
    const std::lock_guard lock(shader_dir().mutex);
    dir = shader_dir().path;
  }
  if (!dir.empty()) {
    const std::size_t plus = name.find('+');  // SOURCE+MACRO+…
    const std::filesystem::path file = dir / name.substr(0, plus);
    return compile(read_text(file), file, plus == name.npos ? "" : name.substr(plus + 1));
  }
  for (const EmbeddedSpirv* module = embedded_spirv(); module->name != nullptr; ++module)
    if (name == module->name) return {module->words, module->words + module->count};
  throw error(Exit::internal, "There is no embedded shader \"{}\"", name);
}

bool has_spirv(std::string_view name) {
  const std::lock_guard lock(shader_dir().mutex);
  const std::filesystem::path& dir = shader_dir().path;
  if (!dir.empty()) return std::filesystem::is_regular_file(dir / name.substr(0, name.find('+')));
  const std::vector<std::string_view> names = embedded_shaders();
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<std::string_view> embedded_shaders() {
  std::vector<std::string_view> names;
  for (const EmbeddedSpirv* module = embedded_spirv(); module->name != nullptr; ++module)
    names.emplace_back(module->name);
  return names;
}

}  // namespace weft::gpu
