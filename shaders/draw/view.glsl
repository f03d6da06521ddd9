// The view block, for every draw shader.
#extension GL_EXT_scalar_block_layout : require
#include "view.h"

layout(scalar, set = 0, binding = 0) uniform ViewBlock { View view; };

// Where the particle of a row is in clip space. Layers that the floor presses into one plane would take turns
// from pixel to pixel: their depths differ by up to 0.05 %, the first row, which falls last, nearest.
vec4 cloth_in_clip(vec3 position, uint row) {
  vec4 place = view.clip * vec4(position, 1.0);
  place.z *= 1.0 + 5e-4 * (1.0 - float(row) / float(view.ny * view.cloths));
  return place;
}
