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
READS_VECTORS(built_position)
READS(real4, near_position)
READS(uint, surface_bound)
READS(real4, carrier)
UPDATES(real4, position)
UPDATES(real4, velocity)
UPDATES(uint, collision_state)
WRITES(uint, cells)

layout(local_size_x = kCollisionGroup) in;
layout(push_constant) uniform Push { uint row_index, item; };
layout(constant_id = 0) const uint rows = 1u;  // that an invocation marches down, at most 32

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
  real stale_squared, most, most_squared;
  real3 with_lists;  // motion that all share, since the lists were made
};

real3 gone_since_lists(Look look, uint p, real3 x) {
  precise real3 gone = (x - load_built_position(p).xyz) - look.with_lists;
  return gone;
}

// Whether the particle may have gone farther than it may, and whether the lists are stale with it.
bool look_at(Look look, uint p, inout bool stale) {
  real4 x = position[p];
  real q = squared_length(gone_since_lists(look, p, x.xyz));
  stale = stale || !(q <= look.stale_squared);
  return x.w != 0.0 && (q > look.most_squared || surface_bound[p] != kInfinity);
}

void keep_in_room(Look look, uint p) {
  real4 x = position[p];
  real3 x1 = x.xyz, v0 = velocity[p].xyz, v1 = v0;
  real3 shared_v = carrier[kCarrierVelocity].xyz;
  hold_back(x1, v1, gone_since_lists(look, p, x.xyz), look.most, shared_v);
  uint bits = surface_bound[p];
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

void empty_grid(Cells c) {
  uint all = gl_NumWorkGroups.x * gl_WorkGroupSize.x * gl_NumWorkGroups.y;
  uint own = gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x + gl_GlobalInvocationID.x;
  for (uint b = own; b <= c.bucket_mask + 1u; b += all) cells[b] = 0u;
}

void begin_look(Cells c) {
  bool first = row_index == 0u;
  collision_state[kLongestEdge] = collision_state[kWidestBlock] = 0u;
  if (first) collision_state[kSmallestGap] = kInfinity;
  if (first) mark_stale(c);
  mark_contacts(c);
}

void main() {
  Cells c = cells_of_cloth();
  empty_grid(c);
  uint i = gl_GlobalInvocationID.x, first_row = gl_GlobalInvocationID.y * rows;
  if (i >= c.nx || first_row >= c.ny) return;
  if (i == 0u && first_row == 0u) begin_look(c);
  if (collision_state[kListsArmed] == 0u) return;
  Look look;
  look.stale_squared = collision[0].moved_squared_max_m2;
  look.most = collision[0].roam_max_m;
  precise real most_squared = look.most * look.most;
  look.most_squared = most_squared;
  look.with_lists = carrier[kCarrierBuilt].xyz;
  // Few have to be held back: those wait, since devices that run invocations in step pay for what any does.
  uint waiting = 0u, count = min(rows, c.ny - first_row);
  bool stale = false;
  for (uint r = 0u; r < count; ++r)
    if (look_at(look, (first_row + r) * c.nx + i, stale)) waiting |= 1u << r;
  if (stale) mark_stale(c);
  for (; waiting != 0u; waiting &= waiting - 1u)
    keep_in_room(look, (first_row + uint(findLSB(waiting))) * c.nx + i);
}
