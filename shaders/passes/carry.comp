#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// The motion that all of the cloth shares, since the lists were made, since contacts were last looked at, and
// now: the mean of 64 particles spread over it. What everyone does brings no two nearer. Nothing where
// something is pinned, which does not take part; and contacts know of none where there is something to fall
// on: layers that lie there must not be taken along by those that still fall.
// One workgroup; the sums are taken by halves, in a fixed order.

#include "../shared/cells.glsl"
READS(real4, position)
READS(real4, velocity)
READS(real4, built_position)
READS(real4, near_position)
WRITES(real4, carrier)

layout(local_size_x = kCarrierSamples) in;

shared real3 since_built[kCarrierSamples];
shared real3 since_near[kCarrierSamples];
shared real3 speed[kCarrierSamples];

void main() {
  uint lane = gl_LocalInvocationID.x;
  uint i = (2u * (lane % 8u) + 1u) * params.nx / 16u, j = (2u * (lane / 8u) + 1u) * params.ny / 16u;
  uint p = j * params.nx + i;
  uint carried = collision[0].carried;
  precise real3 x = position[p].xyz;
  precise real3 from_built = x - built_position[p].xyz, from_near = x - near_position[p].xyz;
  since_built[lane] = carried != 0u ? from_built : real3(0.0);
  since_near[lane] = carried == 2u ? from_near : real3(0.0);
  speed[lane] = carried == 2u ? velocity[p].xyz : real3(0.0);
  for (uint half_count = kCarrierSamples / 2u; half_count > 0u; half_count /= 2u) {
    barrier();
    if (lane >= half_count) continue;
    precise real3 built = since_built[lane] + since_built[lane + half_count];
    precise real3 near = since_near[lane] + since_near[lane + half_count];
    precise real3 v = speed[lane] + speed[lane + half_count];
    since_built[lane] = built;
    since_near[lane] = near;
    speed[lane] = v;
  }
  if (lane != 0u) return;
  carrier[kCarrierBuilt] = real4(since_built[0] / real(kCarrierSamples), 0.0);
  carrier[kCarrierNear] = real4(since_near[0] / real(kCarrierSamples), 0.0);
  carrier[kCarrierVelocity] = real4(speed[0] / real(kCarrierSamples), 0.0);
}
