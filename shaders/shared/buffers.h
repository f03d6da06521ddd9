// The buffer dictionary: one row a buffer. Both languages, the plan's byte counts, Vulkan object
// names and the validator's reports come from here. `READS`/`WRITES` in pass.glsl use the bindings.
#ifndef WEFT_SHARED_BUFFERS_H
#define WEFT_SHARED_BUFFERS_H

// ROW(name, binding, element, unit); how many elements: src/plan/buffers.cpp
#define WEFT_BUFFERS(ROW)                                                                        \
  ROW(params, 0, Params, "the parameter block")                                                  \
  ROW(substeps, 1, vec4, "per-dispatch rows: kick, drift, wind, collider places (params.h)")     \
  ROW(position, 2, vec4, "m; w = inverse mass relative to an interior particle, 0 when pinned")  \
  ROW(position_next, 3, vec4, "the other half of position's ping-pong")                          \
  ROW(velocity, 4, vec4, "m/s; w unused")                                                        \
  ROW(velocity_next, 5, vec4, "the other half of velocity's ping-pong")                          \
  ROW(normal, 6, vec4, "unit vertex normal; w unused")

#endif
