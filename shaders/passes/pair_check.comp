#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Looks at every particle's motion since its surroundings were looked at. One that has gone farther than is
// certain to be free is put back to there: no two surfaces can have passed each other then. And it asks
// whether the lists still hold, and whether contacts are due. Also empties the grid for the passes that would
// make the lists anew.
// Each invocation writes its own particle and its own words of the grid; all that find the lists stale write
// the same answer, the workgroups of the indirect dispatches that follow: no order matters. Of others it
// reads the centre only, which is never put back, since its motion is everyone's. Source: Verlet 1967 (lists
// with a margin); Chen et al. 2025, Offset geometric contact, section 3.4 (the bound on motion);
// docs/effects.md "Self-collision".

#include "../shared/cells.glsl"
#include "../shared/dot.glsl"
READS(real4, built_position)
READS(real4, near_position)
READS(uint, surface_bound)
READS(real4, carrier)
UPDATES(real4, position)
UPDATES(real4, velocity)
UPDATES(uint, collision_state)
WRITES(uint, cells)

layout(local_size_x = kCollisionGroup) in;
layout(push_constant) uniform Push { uint row_index, item; };
layout(constant_id = 0) const uint rows = 1u;  // that an invocation marches down; the device's choice

// Puts x back to within `most` of where the lists or contacts know it, and its velocity to as much of what it
// was. `gone` is how far it is from there.
void hold_back(inout real3 x, inout real3 v, real3 gone, real most, real3 shared_v) {
  real q = dot3(gone, gone);
  precise real limit = most * most;
  if (!(q > limit)) return;
  precise real cut = 1.0 - most / sqrt(q);
  precise real3 back = cut * gone;
  precise real3 nearer = x - back;
  precise real3 lost = cut * (v - shared_v);
  precise real3 slower = v - lost;
  x = nearer;
  v = slower;
  atomicAdd(collision_state[kHeldBack], 1u);
}

void mark_contacts(Cells c) {
  if (collision_state[kPairsListed] != 0u)
    atomicOr(collision_state[kContactGroups], (c.nx + kCollisionGroup - 1u) / kCollisionGroup);
}

void mark_stale(Cells c) {
  atomicOr(collision_state[kListGroups], ((c.nx + 1u) / 2u + kCollisionGroup - 1u) / kCollisionGroup);
  atomicOr(collision_state[kBlockGroups], ((c.nx + 3u) / 4u + kCollisionGroup - 1u) / kCollisionGroup);
  atomicOr(collision_state[kNearGroups], 1u);  // at least: patch_near knows how many
  atomicOr(collision_state[kScanGroups], 1u);
}

// What is the same for all particles, read once.
struct Look {
  bool armed;
  real stale_squared, most, most_squared;
  real3 with_lists;  // motion that all share, since the lists were made
};

void look_at(Cells c, Look look, uint p) {
  if (p <= c.bucket_mask + 1u) cells[p] = 0u;
  if (!look.armed) return;
  real4 x = position[p];
  precise real3 gone = (x.xyz - built_position[p].xyz) - look.with_lists;
  real q = squared_length(gone);
  if (!(q <= look.stale_squared)) mark_stale(c);
  if (x.w == 0.0) return;
  uint bits = surface_bound[p];
  if (!(q > look.most_squared) && bits == kInfinity) return;
  real3 x1 = x.xyz, v0 = velocity[p].xyz, v1 = v0;
  real3 shared_v = carrier[kCarrierVelocity].xyz;
  hold_back(x1, v1, gone, look.most, shared_v);
  if (bits != kInfinity) {
    precise real3 since = (x1 - near_position[p].xyz) - carrier[kCarrierNear].xyz;
    real near = real(uintBitsToFloat(bits));
    precise real room = near * min((2.0 * near) / collision[0].surface_limit_m, 1.0);
    precise real most = kRoamShare * room;
    hold_back(x1, v1, since, most, shared_v);
  }
  position[p] = real4(x1, x.w);
  velocity[p] = real4(v1, 0.0);
}

void begin_look(Cells c) {
  bool first = row_index == 0u;
  collision_state[kLongestEdge] = collision_state[kWidestPatch] = 0u;
  if (first) collision_state[kSmallestGap] = kInfinity;
  if (first) mark_stale(c);
  mark_contacts(c);
}

void main() {
  Cells c = cells_of_cloth();
  uint i = gl_GlobalInvocationID.x, first_row = gl_GlobalInvocationID.y * rows;
  if (i >= c.nx || first_row >= c.ny) return;
  if (i == 0u && first_row == 0u) begin_look(c);
  Look look;
  look.armed = collision_state[kListsArmed] != 0u;
  look.stale_squared = collision[0].moved_squared_max_m2;
  look.most = collision[0].roam_max_m;
  precise real most_squared = look.most * look.most;
  look.most_squared = most_squared;
  look.with_lists = carrier[kCarrierBuilt].xyz;
  uint end_row = min(first_row + rows, c.ny);
  for (uint j = first_row; j < end_row; ++j) look_at(c, look, j * c.nx + i);
}
