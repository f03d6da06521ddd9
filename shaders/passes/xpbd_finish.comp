#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Velocities from what the particles have moved, then contact. position_next holds the moves, then the
// places.
// Each invocation reads and writes its own particle only: no races.
// Source: Macklin et al. 2019, Small Steps in Physics Simulation, algorithm 1; docs/solvers.md "xpbd".

READS (real4, substeps)
READS (real4, position)
READS (real4, velocity)
UPDATES(real4, position_next)
WRITES(real4, velocity_next)

layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint row_index; };

layout(constant_id = 0) const bool floor_contact = true;
layout(constant_id = 1) const uint sphere_number = 1u;  // up to 2; more count as 3
#include "../shared/dot.glsl"
#include "../shared/contact.glsl"
#include "../shared/reach.glsl"

void main() {
  uint i = gl_GlobalInvocationID.x, j = gl_GlobalInvocationID.y;
  if (i >= params.nx || j >= params.ny) return;
  uint p = j * params.nx + i, row = row_index * params.row_stride;
  hold_spheres(row);
  hold_reach(row);
  real4 own = position[p];
  real3 x0 = own.xyz;
  precise real3 x1 = x0;
  precise real3 v = velocity[p].xyz;
  if (own.w != 0.0) {
    precise real3 moved = position_next[p].xyz;
    x1 = x0 + moved;
    v = moved / substeps[row + 1u].y;
    if (spheres || floor_contact) contact(row, x0, x1, v);
    look_for_bodies(x0, x1);
  }
  position_next[p] = real4(x1, own.w);
  velocity_next[p] = real4(v, 0.0);
  tell_reach();
}
