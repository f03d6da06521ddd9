// What every pass includes: the dictionary's bindings, the parameter block, and the words READS, WRITES
// and UPDATES that declare its interface. The host reads access and strides back from the SPIR-V.
#extension GL_EXT_scalar_block_layout : require
#if defined(WEFT_REACH) || defined(WEFT_SPREAD)
#extension GL_KHR_shader_subgroup_basic : require
#endif
#include "buffers.h"
#include "params.h"

#define WEFT_BINDING(name, binding, element, unit) const uint kBinding_##name = binding;
WEFT_BUFFERS(WEFT_BINDING)
#undef WEFT_BINDING

#define READS(type, name) \
  layout(scalar, set = 0, binding = kBinding_##name) restrict readonly buffer Block_##name { type name[]; };
#define WRITES(type, name) \
  layout(scalar, set = 0, binding = kBinding_##name) restrict writeonly buffer Block_##name { type name[]; };
#define UPDATES(type, name) \
  layout(scalar, set = 0, binding = kBinding_##name) restrict buffer Block_##name { type name[]; };

// A buffer of vec4 read as texels, by NAME_texel(index): nearly three times as fast on software devices.
#define READS_TEXELS(name)                                                        \
  layout(set = 0, binding = kBinding_##name) uniform samplerBuffer Texels_##name; \
  vec4 name##_texel(uint index) { return texelFetch(Texels_##name, int(index)); }

// A buffer of real4 read by load_NAME(index): as texels where the kernel takes them.
#ifdef WEFT_TEXELS
#define READS_VECTORS(name) \
  READS_TEXELS(name)        \
  vec4 load_##name(uint index) { return name##_texel(index); }
#else
#define READS_VECTORS(name) \
  READS(real4, name)        \
  real4 load_##name(uint index) { return name[index]; }
#endif

layout(scalar, set = 0, binding = kBinding_params) restrict readonly buffer Block_params { Params params; };
