#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Looks at every listed pair of a particle and a triangle and of two edges: how far each of its particles may
// move before the pair is looked at again, how many touch, and the smallest distance of all.
// Counts and minima are integers (the bits of a float that is not negative ascend with it), taken atomically:
// they do not depend on any order.
// Source: Chen et al. 2025, Offset geometric contact, section 3.4; docs/effects.md "Self-collision".

#include "../shared/cells.glsl"
#include "../shared/dot.glsl"
READS(real4, near_position)
READS(uint, surface_count)
READS(uint, surface_pairs)
UPDATES(uint, collision_state)
UPDATES(uint, surface_bound)
UPDATES(uint, touch_weight)

layout(local_size_x = kCollisionGroup) in;

#include "../shared/surface.glsl"
#include "../shared/touching.glsl"

void main() {
  Cells c = cells_of_cloth();
  Own own;
  if (!own_particle(c, own)) return;
  if (own.particle == 0u) collision_state[kContactGroups] = 0u;  // done: nothing is due
  uint entries = surface_count[own.particle], smallest = kInfinity;
  bool any = false;
  for (uint k = 0u; k < entries; ++k) {
    Touching it = touching_of(c, own.particle, surface_pairs[k * c.count + own.particle]);
    uint bits = floatBitsToUint(float(sqrt(it.q)));
    bool touches = it.q < collision[0].surface_limit_squared_m2;
    any = any || touches;
    for (uint m = 0u; m < 4u; ++m) {
      atomicMin(surface_bound[it.particle[m]], bits);
      if (touches) atomicAdd(touch_weight[it.particle[m]], touch_units(abs(it.weight[m])));
    }
    smallest = min(smallest, bits);
  }
  if (any) mark_touching(c);
  if (smallest < collision_state[kSmallestGap]) atomicMin(collision_state[kSmallestGap], smallest);
}
