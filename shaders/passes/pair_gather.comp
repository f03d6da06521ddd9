#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Lists, for every particle, those that could come nearer than their limit before the lists are made anew:
// the members of the eight cells nearest to it that are within limit + skin. A cell is twice as wide as
// that, so that eight suffice; a bucket may hold particles of several cells, and each is taken only where
// its own cell is asked for, so none is taken twice.
// Each invocation writes its own particle's list: no races.
// Source: Green 2008, Particle simulation using CUDA; Verlet 1967.

#include "../shared/cells.glsl"
READS(real4, position)
READS(uint, cells)
READS(uint, cell_members)
UPDATES(uint, collision_state)
WRITES(uint, pair_count)
WRITES(uint, pair_places)

layout(local_size_x = kCollisionGroup) in;

// How many entries the particle's list has found so far; those beyond the room are counted only.
uint gather_from(Cells c, ivec3 cell, Own own, real3 x, real reach_max, uint found) {
  uint bucket = bucket_of(c, cell), end = cells[bucket + 1u];
  for (uint slot = cells[bucket]; slot < end; ++slot) {
    uint place = cell_members[slot], other = particle_at(c, place);
    real3 there = position[other].xyz;
    precise real3 d = there - x;
    real q = squared_length(d);
    if (!(q < reach_max) || place == own.place || cell_of(c, there, other) != cell) continue;
    if (!(q < collision[0].limits[limit_row(c, own, place)].z)) continue;
    if (found < collision[0].capacity) pair_places[found * c.count + own.particle] = place;
    ++found;
  }
  return found;
}

void main() {
  if (collision_state[kListGroups] == 0u) return;
  Cells c = cells_of_cloth();
  Own own;
  if (!own_particle(c, own)) return;
  real3 x = position[own.particle].xyz;
  real reach_max = collision[0].limits[c.limit_last].z;
  uint found = 0u;
  if (covered(c, x)) {
    ivec3 corner = corner_cell(c, x);
    for (uint k = 0u; k < 8u; ++k) {
      ivec3 cell = corner + ivec3(k & 1u, (k >> 1u) & 1u, k >> 2u);
      found = gather_from(c, cell, own, x, reach_max, found);
    }
  }
  uint kept = min(found, collision[0].capacity);
  pair_count[own.particle] = kept;
  if (kept > 0u) {
    atomicOr(collision_state[kPairsListed], 1u);
    atomicOr(collision_state[kContactGroups], (c.nx + kCollisionGroup - 1u) / kCollisionGroup);
  }
  if (found > kept) atomicAdd(collision_state[kPairsDropped], found - kept);
}
