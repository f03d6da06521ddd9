// What one picture needs to know: camera, light, floor, balls. One uniform block, read by every draw
// shader and written by src/render/view.cpp.
#ifndef WEFT_DRAW_VIEW_H
#define WEFT_DRAW_VIEW_H
#include "../shared/types.h"
#ifdef __cplusplus
#include <glm/mat4x4.hpp>
namespace weft::shared {
using glm::mat4;
}
#endif

WEFT_SHARED_BEGIN

WEFT_CONST uint kMaxBalls = 128u;  // 64 colliding spheres and 64 pin heads

struct View {
  mat4 clip;         // world to clip space; depth is 1 at the near plane and 0 infinitely far
  mat4 shadow_clip;  // world to the shadow map, orthographic, depth 0 nearest to the light
  vec3 eye_m;
  float floor_m;    // the drawn floor's height where x = z = 0
  vec3 ray_right;   // a picture's view ray is forward + x·right + y·up for x, y in −1…1
  float checker_m;  // edge of one floor square
  vec3 ray_up;
  float fade_m;  // distance from `focus` over which the floor fades into the horizon
  vec3 ray_forward;
  float shadow_texel_m;  // edge of one shadow map texel
  vec3 focus_m;          // the middle of what is worth looking at
  float shadow_depth_m;  // length of the shadow map's depth range
  vec3 to_light;         // unit vector
  float heat_full;       // the strain that the heat map paints in full colour
  vec2 cloth_m;          // width and height of the flat cloth
  float spacing_m;       // edge of a cell
  uint nx, ny;           // particles of one cloth
  uint sphere_count;     // balls before this one are colliding spheres, the rest are pin heads
  uint ball_count;
  uint cloths;
  vec3 floor_normal;      // unit vector
  vec4 balls[kMaxBalls];  // xyz = centre [m], w = drawn radius [m]
};

WEFT_SHARED_END
#endif
