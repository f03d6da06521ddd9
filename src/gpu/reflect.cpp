// A reader of SPIR-V modules: bindings, access, strides, workgroup size, push constants, constants.
// The numbers below are the SPIR-V specification's (unified 1.6, "Binary Form").
#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

#include "core/error.h"
#include "gpu/shader.h"

namespace weft::gpu {
namespace {

enum Op : std::uint32_t {
  kExecutionMode = 16,
  kTypeBool = 20,
  kTypeInt = 21,
  kTypeFloat = 22,
  kTypeVector = 23,
  kTypeMatrix = 24,
  kTypeImage = 25,
  kTypeSampler = 26,
  kTypeSampledImage = 27,
  kTypeArray = 28,
  kTypeRuntimeArray = 29,
  kTypeStruct = 30,
  kTypePointer = 32,
  kConstant = 43,
  kConstantComposite = 44,
  kSpecConstantTrue = 48,
  kSpecConstantFalse = 49,
  kSpecConstant = 50,
  kSpecConstantComposite = 51,
  kVariable = 59,
  kDecorate = 71,
  kMemberDecorate = 72,
  kExecutionModeId = 331,
};

enum Decoration : std::uint32_t {
  kSpecId = 1,
  kBufferBlock = 3,
  kArrayStride = 6,
  kMatrixStride = 7,
  kBuiltIn = 11,
  kNonWritable = 24,
  kNonReadable = 25,
  kBinding = 33,
  kDescriptorSet = 34,
  kOffset = 35,
};

enum StorageClass : std::uint32_t {
  kUniformConstant = 0,
  kUniform = 2,
  kPushConstant = 9,
  kStorageBuffer = 12
};

constexpr std::uint32_t kMagic = 0x07230203;
constexpr std::uint32_t kLocalSize = 17, kLocalSizeId = 38, kWorkgroupSize = 25;
constexpr std::uint32_t kDimBuffer = 5, kDimSubpass = 6;

using Words = std::span<const std::uint32_t>;  // operands, after the word that holds the opcode

struct Type {
  std::uint32_t op = 0;
  std::vector<std::uint32_t> operands;  // after the result id
};

struct Decorations {
  std::map<std::uint32_t, std::uint32_t> values;  // decoration → its first operand, 0 when it has none
  bool has(std::uint32_t d) const { return values.contains(d); }
  std::uint32_t get(std::uint32_t d, std::uint32_t otherwise = 0) const {
    const auto found = values.find(d);
    return found == values.end() ? otherwise : found->second;
  }
};

struct Variable {
  std::uint32_t id, pointer_type, storage;
};

struct Module {
  std::map<std::uint32_t, Type> types;
  std::map<std::uint32_t, Decorations> decorations;
  std::map<std::uint32_t, std::map<std::uint32_t, Decorations>> members;
  std::map<std::uint32_t, std::uint32_t> constants;  // id → low word, specialised
  std::map<std::uint32_t, std::vector<std::uint32_t>> composites;
  std::vector<Variable> variables;
  std::vector<std::uint32_t> local_size, local_size_ids;  // three each, or empty

  const Decorations& of(std::uint32_t id) const {
    static const Decorations none;
    const auto found = decorations.find(id);
    return found == decorations.end() ? none : found->second;
  }
  const Decorations& of_member(std::uint32_t id, std::uint32_t member) const {
    static const Decorations none;
    const auto found = members.find(id);
    if (found == members.end() || !found->second.contains(member)) return none;
    return found->second.at(member);
  }
  std::uint32_t constant(std::uint32_t id) const {
    const auto found = constants.find(id);
    return found == constants.end() ? 0 : found->second;
  }
};

[[noreturn]] void broken(const char* what) {
  throw error(Exit::internal, "A SPIR-V module is broken: {}", what);
}

void need(Words words, std::size_t count) {
  if (words.size() < count) broken("an instruction is too short");
}

const Type& type_of(const Module& module, std::uint32_t id) {
  const auto found = module.types.find(id);
  if (found == module.types.end()) broken("a type is missing");
  return found->second;
}

void read_decoration(Module& module, std::uint32_t op, Words w) {
  if (op == kDecorate) {
    need(w, 2);
    module.decorations[w[0]].values[w[1]] = w.size() > 2 ? w[2] : 0;
  } else {
    need(w, 3);
    module.members[w[0]][w[1]].values[w[2]] = w.size() > 3 ? w[3] : 0;
  }
}

/// A constant's value: the caller's when it has a SpecId within the list, else the module's default.
void read_constant(Module& module, std::uint32_t op, Words w, Words specialised) {
  need(w, 2);
  std::uint32_t value = op == kSpecConstantTrue ? 1 : 0;
  if (op == kConstant || op == kSpecConstant) {
    need(w, 3);
    value = w[2];
  }
  const Decorations& decorations = module.of(w[1]);
  if (decorations.has(kSpecId) && decorations.get(kSpecId) < specialised.size())
    value = specialised[decorations.get(kSpecId)];
  module.constants[w[1]] = value;
}

void read_instruction(Module& module, std::uint32_t op, Words w, Words specialised) {
  switch (op) {
    case kDecorate:
    case kMemberDecorate: return read_decoration(module, op, w);
    case kTypeBool:
    case kTypeInt:
    case kTypeFloat:
    case kTypeVector:
    case kTypeMatrix:
    case kTypeImage:
    case kTypeSampler:
    case kTypeSampledImage:
    case kTypeArray:
    case kTypeRuntimeArray:
    case kTypeStruct:
    case kTypePointer:
      need(w, 1);
      module.types[w[0]] = {op, {w.begin() + 1, w.end()}};
      return;
    case kConstant:
    case kSpecConstant:
    case kSpecConstantTrue:
    case kSpecConstantFalse: return read_constant(module, op, w, specialised);
    case kConstantComposite:
    case kSpecConstantComposite:
      need(w, 2);
      module.composites[w[1]] = {w.begin() + 2, w.end()};
      return;
    case kVariable:
      need(w, 3);
      module.variables.push_back({w[1], w[0], w[2]});
      return;
    case kExecutionMode:
      need(w, 2);
      if (w[1] == kLocalSize && w.size() >= 5) module.local_size.assign(w.begin() + 2, w.begin() + 5);
      return;
    case kExecutionModeId:
      need(w, 2);
      if (w[1] == kLocalSizeId && w.size() >= 5) module.local_size_ids.assign(w.begin() + 2, w.begin() + 5);
      return;
    default: return;
  }
}

Module read_module(Words spirv, Words specialised) {
  if (spirv.size() < 5 || spirv[0] != kMagic) broken("its first word is not the magic number");
  Module module;
  for (std::size_t at = 5; at < spirv.size();) {
    const std::uint32_t count = spirv[at] >> 16, op = spirv[at] & 0xffffu;
    if (count == 0 || count > spirv.size() - at) broken("an instruction runs past the end");
    read_instruction(module, op, spirv.subspan(at + 1, count - 1), specialised);
    at += count;
  }
  return module;
}

constexpr int kDeepest = 32;  // nesting of types; a damaged module may hold a type within itself

std::uint32_t size_of(const Module& module, std::uint32_t id, std::uint32_t matrix_stride, int depth = 0);

std::uint32_t struct_size(const Module& module, std::uint32_t id, const Type& type, int depth) {
  std::uint32_t bytes = 0;
  for (std::uint32_t m = 0; m < type.operands.size(); ++m) {
    const Decorations& member = module.of_member(id, m);
    const std::uint32_t size = size_of(module, type.operands[m], member.get(kMatrixStride), depth + 1);
    bytes = std::max(bytes, member.get(kOffset) + size);
  }
  return bytes;
}

/// Bytes of a type in a block; 0 for runtime arrays.
std::uint32_t size_of(const Module& module, std::uint32_t id, std::uint32_t matrix_stride, int depth) {
  if (depth > kDeepest) broken("its types nest too deeply");
  const Type& type = type_of(module, id);
  switch (type.op) {
    case kTypeInt:
    case kTypeFloat: return type.operands.at(0) / 8;
    case kTypeVector: return size_of(module, type.operands.at(0), 0, depth + 1) * type.operands.at(1);
    case kTypeMatrix: {
      const std::uint32_t column = size_of(module, type.operands.at(0), 0, depth + 1);
      return (type.operands.at(1) - 1) * std::max(matrix_stride, column) + column;
    }
    case kTypeArray: {
      const std::uint32_t element = size_of(module, type.operands.at(0), matrix_stride, depth + 1);
      const std::uint32_t stride = module.of(id).get(kArrayStride, element);
      const std::uint32_t count = module.constant(type.operands.at(1));
      return count == 0 ? 0 : (count - 1) * stride + element;
    }
    case kTypeStruct: return struct_size(module, id, type, depth);
    default: return 0;
  }
}

/// What an image, sampler or texel buffer is bound as.
VkDescriptorType opaque_type(const Module& module, const Type& type) {
  if (type.op == kTypeSampler) return VK_DESCRIPTOR_TYPE_SAMPLER;
  const bool combined = type.op == kTypeSampledImage;
  const Type& image = combined ? type_of(module, type.operands.at(0)) : type;
  if (image.op != kTypeImage) broken("a variable is neither a block nor an image");
  const std::uint32_t dim = image.operands.at(1), sampled = image.operands.at(5);
  if (dim == kDimSubpass) return VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT;
  if (dim == kDimBuffer)
    return sampled == 1 ? VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
  if (combined) return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
  return sampled == 1 ? VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
}

/// True when the variable, or every member of its block, carries the decoration.
bool decorated(const Module& module, std::uint32_t variable, std::uint32_t type_id,
               std::uint32_t decoration) {
  if (module.of(variable).has(decoration)) return true;
  const Type& type = type_of(module, type_id);
  if (type.op != kTypeStruct || type.operands.empty()) return false;
  for (std::uint32_t m = 0; m < type.operands.size(); ++m)
    if (!module.of_member(type_id, m).has(decoration)) return false;
  return true;
}

/// Stride of the runtime array that ends a block, 0 when there is none.
std::uint32_t runtime_stride(const Module& module, const Type& block) {
  if (block.operands.empty()) return 0;
  const std::uint32_t last = block.operands.back();
  return type_of(module, last).op == kTypeRuntimeArray ? module.of(last).get(kArrayStride) : 0;
}

Binding binding_of(const Module& module, const Variable& variable, std::uint32_t type_id) {
  Binding binding;
  binding.set = module.of(variable.id).get(kDescriptorSet);
  binding.binding = module.of(variable.id).get(kBinding);
  if (type_of(module, type_id).op == kTypeArray) {
    binding.count = module.constant(type_of(module, type_id).operands.at(1));
    type_id = type_of(module, type_id).operands.at(0);
  }
  const Type& type = type_of(module, type_id);
  const bool storage = variable.storage == kStorageBuffer ||
                       (variable.storage == kUniform && module.of(type_id).has(kBufferBlock));
  if (storage)
    binding.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  else if (variable.storage == kUniform)
    binding.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  else
    binding.type = opaque_type(module, type);
  const bool writable = storage || binding.type == VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER ||
                        binding.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
  binding.writes = writable && !decorated(module, variable.id, type_id, kNonWritable);
  binding.reads = !decorated(module, variable.id, type_id, kNonReadable);
  if (storage) binding.stride = runtime_stride(module, type);
  return binding;
}

/// The constant decorated as built-in WorkgroupSize wins, then LocalSizeId, then LocalSize.
void set_local_size(const Module& module, Reflection& reflection) {
  std::vector<std::uint32_t> ids = module.local_size_ids;
  for (const auto& [id, parts] : module.composites)
    if (parts.size() == 3 && module.of(id).has(kBuiltIn) && module.of(id).get(kBuiltIn) == kWorkgroupSize)
      ids = parts;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!ids.empty())
      reflection.local_size[axis] = module.constant(ids[axis]);
    else if (!module.local_size.empty())
      reflection.local_size[axis] = module.local_size[axis];
  }
}

Reflection interface_of(const Module& module) {
  Reflection reflection;
  for (const Variable& variable : module.variables) {
    const Type& pointer = type_of(module, variable.pointer_type);
    if (pointer.op != kTypePointer || pointer.operands.size() < 2) broken("a variable's type is no pointer");
    const std::uint32_t type_id = pointer.operands[1];
    if (variable.storage == kPushConstant)
      reflection.push_constant_bytes = size_of(module, type_id, 0);
    else if (module.of(variable.id).has(kBinding))
      reflection.bindings.push_back(binding_of(module, variable, type_id));
  }
  std::sort(reflection.bindings.begin(), reflection.bindings.end(), [](const Binding& a, const Binding& b) {
    return a.set != b.set ? a.set < b.set : a.binding < b.binding;
  });
  std::set<std::uint32_t> ids;
  for (const auto& [id, decorations] : module.decorations)
    if (decorations.has(kSpecId)) ids.insert(decorations.get(kSpecId));
  reflection.constant_ids.assign(ids.begin(), ids.end());
  set_local_size(module, reflection);
  return reflection;
}

}  // namespace

Reflection reflect(std::span<const std::uint32_t> spirv, std::span<const std::uint32_t> constants) {
  try {
    return interface_of(read_module(spirv, constants));
  } catch (const std::out_of_range&) {  // an operand that must be there is not
    broken("an instruction is too short");
  }
}

}  // namespace weft::gpu
