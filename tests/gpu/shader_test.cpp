// Compiling at run time, reading a module's interface, and the rules every embedded module keeps.
#include "gpu/shader.h"

#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "gtest/gtest.h"
#include "support/full_run.h"

namespace weft {
namespace {

using namespace gpu;

const Binding& at(const Reflection& reflection, std::uint32_t binding) {
  for (const Binding& b : reflection.bindings)
    if (b.binding == binding) return b;
  throw error(Exit::internal, "binding {} is missing", binding);
}

/// A folder that is removed at the end.
class Folder {
 public:
  Folder() : path_(std::filesystem::path(WEFT_BINARY_DIR) / "test-shaders") {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_ / "passes");
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  void write(const std::string& name, const std::string& text) const { std::ofstream(path_ / name) << text; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

constexpr const char* kEverything = R"(#version 460
#extension GL_EXT_scalar_block_layout : require
layout(local_size_x_id = 4, local_size_y = 2) in;
layout(constant_id = 0) const bool flag = true;
layout(constant_id = 9) const float gain = 2.0;
layout(scalar, push_constant) uniform Push { vec3 shift; uint count; mat3 turn; float tail[3]; } push;
struct Row { vec3 a; float b; vec2 c; };
layout(scalar, set = 0, binding = 8) restrict writeonly buffer Out { vec4 result[]; };
layout(scalar, set = 0, binding = 0) restrict readonly buffer In { uint head; Row rows[]; };
layout(scalar, set = 0, binding = 3) restrict buffer Both { vec3 state[]; };
layout(scalar, set = 0, binding = 5) uniform Block { vec4 tint; } block;
layout(set = 0, binding = 6) uniform samplerBuffer texels;
layout(set = 0, binding = 7, rgba32f) uniform writeonly imageBuffer stores;
layout(set = 1, binding = 2) uniform sampler2D pictures[4];
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (flag && i < push.count) {
    Row row = rows[i];
    state[i] += push.turn * row.a * row.b + vec3(row.c, push.tail[2]) + push.shift;
    result[i] = block.tint * gain + texelFetch(texels, int(head)) + textureLod(pictures[1], row.c, 0.0);
    imageStore(stores, int(i), result.length() > 1 ? block.tint : vec4(0.0));
  }
}
)";

// Numbers by the scalar layout: Row is 12 + 4 + 8 = 24 bytes; the push block 12 + 4 + 36 + 12 = 64.
TEST(Reflect, AKnownInterfaceIsReadBack) {
  const auto spirv = compile_glsl_text(kEverything, "everything.comp");
  const Reflection r = reflect(spirv);
  ASSERT_EQ(r.bindings.size(), 7u);
  EXPECT_EQ(r.push_constant_bytes, 64u);
  EXPECT_EQ(r.constant_ids, (std::vector<std::uint32_t>{0, 4, 9}));
  EXPECT_EQ(r.local_size[1], 2u);

  EXPECT_EQ(at(r, 0).type, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
  EXPECT_TRUE(at(r, 0).reads && !at(r, 0).writes);
  EXPECT_EQ(at(r, 0).stride, 24u);
  EXPECT_TRUE(at(r, 3).reads && at(r, 3).writes);
  EXPECT_EQ(at(r, 3).stride, 12u);
  EXPECT_TRUE(!at(r, 8).reads && at(r, 8).writes);
  EXPECT_EQ(at(r, 8).stride, 16u);
  EXPECT_EQ(at(r, 5).type, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER);
  EXPECT_TRUE(at(r, 5).reads && !at(r, 5).writes);
  EXPECT_EQ(at(r, 6).type, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER);
  EXPECT_TRUE(at(r, 6).reads && !at(r, 6).writes);
  EXPECT_EQ(at(r, 7).type, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER);
  EXPECT_TRUE(!at(r, 7).reads && at(r, 7).writes);
  EXPECT_EQ(at(r, 2).type, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
  EXPECT_EQ(at(r, 2).set, 1u);
  EXPECT_EQ(at(r, 2).count, 4u);
}

TEST(Reflect, SpecializationDecidesTheLocalSize) {
  const auto spirv = compile_glsl_text(kEverything, "everything.comp");
  EXPECT_EQ(reflect(spirv).local_size[0], 1u);  // GLSL's default of local_size_x_id
  const std::uint32_t constants[] = {1, 0, 0, 0, 32};
  EXPECT_EQ(reflect(spirv, constants).local_size[0], 32u);
  EXPECT_EQ(reflect(spirv, constants).local_size[1], 2u);
}

TEST(Reflect, WhatIsNoModuleIsRefused) {
  auto spirv = compile_glsl_text(kEverything, "everything.comp");
  EXPECT_THROW(reflect({}), Error);
  EXPECT_THROW(reflect(std::span(spirv).first(6)), Error);  // the first instruction has two words
  spirv[0] ^= 1u;
  EXPECT_THROW(reflect(spirv), Error);
}

// Cut at every word, and with every word damaged, the reader must answer or throw Error; the sanitizers
// see anything else.
TEST(Reflect, DamagedModulesNeverCrash) {
  const auto whole = compile_glsl_text(kEverything, "everything.comp");
  int refused = 0;
  for (std::size_t i = 5; i < whole.size(); ++i) {
    auto damaged = whole;
    damaged[i] ^= 0x00010003u;
    for (const auto words : {std::span<const std::uint32_t>(damaged), std::span(whole).first(i)}) {
      try {
        reflect(words);
      } catch (const Error&) {
        ++refused;
      } catch (const std::exception& other) {
        ADD_FAILURE() << "word " << i << ": " << other.what();
      }
    }
  }
  EXPECT_GT(refused, 0);
}

TEST(Compile, ErrorsNameFileAndLine) {
  try {
    compile_glsl_text("#version 460\nvoid main() {\n  float x = nowhere;\n}\n", "dir/bad.comp");
    FAIL() << "nonsense compiled";
  } catch (const Error& problem) {
    EXPECT_EQ(problem.code(), Exit::usage);
    EXPECT_NE(std::string(problem.what()).find("dir/bad.comp:3:"), std::string::npos) << problem.what();
  }
  EXPECT_THROW(compile_glsl_text("", "name.txt"), Error);
}

TEST(Compile, IncludesAreFoundBesideTheIncludingFile) {
  const Folder folder;
  std::filesystem::create_directories(folder.path() / "shared/deep");
  folder.write("shared/a.h", "#include \"deep/b.h\"\n");
  folder.write("shared/deep/b.h", "layout(local_size_x = 24) in;\n");
  folder.write("passes/x.comp",
               "#version 460\n#extension GL_GOOGLE_include_directive : require\n"
               "#include \"../shared/a.h\"\nvoid main() {}\n");
  EXPECT_EQ(reflect(compile_glsl(folder.path() / "passes/x.comp")).local_size[0], 24u);

  folder.write("shared/deep/b.h", "layout(local_size_x = 24) in;\nbroken\n");
  try {
    compile_glsl(folder.path() / "passes/x.comp");
    FAIL() << "a broken include compiled";
  } catch (const Error& problem) {
    EXPECT_NE(std::string(problem.what()).find("deep/b.h:"), std::string::npos) << problem.what();
  }
  std::filesystem::remove(folder.path() / "shared/a.h");
  try {
    compile_glsl(folder.path() / "passes/x.comp");
    FAIL() << "a missing include compiled";
  } catch (const Error& problem) {
    EXPECT_EQ(problem.code(), Exit::usage);
    EXPECT_NE(std::string(problem.what()).find("x.comp:3:"), std::string::npos) << problem.what();
  }
}

TEST(Compile, AShaderFolderReplacesTheEmbeddedModules) {
  const Folder folder;
  folder.write("passes/y.comp", "#version 460\nlayout(local_size_x = 40) in;\nvoid main() {}\n");
  set_shader_dir(folder.path());
  const Reflection r = reflect(load_spirv("passes/y.comp"));
  EXPECT_THROW(load_spirv("passes/missing.comp"), Error);
  set_shader_dir({});
  EXPECT_EQ(r.local_size[0], 40u);
  EXPECT_THROW(load_spirv("passes/y.comp"), Error);
  EXPECT_THROW(set_shader_dir(folder.path() / "nowhere"), Error);
}

// What docs/ARCHITECTURE.md promises to ask of a device: 256 invocations, 128 bytes, x a multiple of 8.
TEST(Embedded, EveryModuleReflectsAndKeepsThePlatformRules) {
  ASSERT_FALSE(embedded_shaders().empty());
  for (const std::string_view name : embedded_shaders()) {
    SCOPED_TRACE(name);
    const Reflection r = reflect(load_spirv(name));
    EXPECT_LE(r.push_constant_bytes, 128u);
    if (!name.ends_with(".comp")) continue;
    EXPECT_FALSE(r.bindings.empty());
    for (const Binding& b : r.bindings) {
      EXPECT_EQ(b.set, 0u);
      EXPECT_TRUE(b.reads || b.writes);
    }
    // Where it is a specialization constant (id 12), the host sets it for the kernel it has chosen.
    const bool specialised = std::count(r.constant_ids.begin(), r.constant_ids.end(), 12u) > 0;
    EXPECT_TRUE(specialised || r.local_size[0] % 8 == 0) << r.local_size[0];
    EXPECT_LE(r.local_size[0] * r.local_size[1] * r.local_size[2], 256u);
  }
}

// The build's glslc and the program's shaderc must agree, or a shader folder would change results.
// Every fifth one in the quick run: they are compiled by the same code with the same options.
TEST(Embedded, RunTimeCompilationGivesTheSameWords) {
  const auto names = embedded_shaders();
  const std::size_t stride = test::full_run() ? 1 : 5;
  for (std::size_t k = 0; k < names.size(); k += stride) {
    set_shader_dir(std::filesystem::path(WEFT_SOURCE_DIR) / "shaders");
    const auto compiled = load_spirv(names[k]);
    set_shader_dir({});
    EXPECT_EQ(compiled, load_spirv(names[k])) << names[k];
  }
}

}  // namespace
}  // namespace weft
