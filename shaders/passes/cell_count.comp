#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "../shared/pass.glsl"

// First third of the counting sort: the box of each patch and each block, and how many blocks each bucket of
// the grid holds. And the longest edge and the widest block, by which the searches know how far to look; and
// where the cloth is spread out and where it bends. Begins the lists. Counts are integers added atomically:
// their sums do not depend on the order, nor do the greatest. Source: Green 2008, Particle simulation using
// CUDA, "Building the grid using atomic operations".

#include "../shared/cells.glsl"
#include "../shared/dot.glsl"
READS_VECTORS(position)
UPDATES(uint, collision_state)
WRITES(real4, built_position)
WRITES(real4, patches)
WRITES(real4, blocks)
WRITES(uint, pair_count)
WRITES(uint, surface_count)
WRITES(uint, surface_bound)
UPDATES(uint, cells)

layout(local_size_x = kCollisionGroup) in;
layout(constant_id = 0) const uint rows = 1u;  // of patches that an invocation marches down

#include "../shared/surface.glsl"
#include "../shared/patches.glsl"
#include "../shared/folds.glsl"

// The longest squared edge from a particle to the right, below, and below to the left. What lies beyond the
// cloth's ends stands where its last particle does, so that there it is an edge once more, or nothing.
real longest_edge(const int i, const int j) {
  real3 x = x_at(i, j);
  precise real3 d0 = x_at(i + 1, j) - x, d1 = x_at(i, j + 1) - x, d2 = x_at(i - 1, j + 1) - x;
  return max(max(squared_length(d0), squared_length(d1)), squared_length(d2));
}

// Whether a particle of the patch may have another on its list that is not beside it but of this patch or one
// beside it.
bool close() {
  real most = collision[0].patch_search_squared_m2;
  uint found = 0u;
  [[unroll]] for (int j = 0; j < kAcross; ++j)
    [[unroll]] for (int i = 0; i < kAcross; ++i) {
      uint near = 0u;
      [[unroll]] for (int k = 0; k < 4; ++k) {
        const int p = 2 + k % 2, q = 2 + k / 2;
        precise real3 d = x_at(i, j) - x_at(p, q);
        if (max(abs(i - p), abs(j - q)) > 1)
          near |= has_column[p] & has_row[q] & uint(squared_length(d) < most);
      }
      found |= near & has_column[i] & has_row[j];
    }
  return found != 0u;
}

void raise(uint word, real value) {
  uint bits = floatBitsToUint(float(value));
  if (bits > collision_state[word]) atomicMax(collision_state[word], bits);
}

// What all patches of the march have in common at its end.
struct Greatest {
  real edge_squared, side;
};

// Where the patch's particles are as the lists are made; and their lists, empty until they are found to have
// something near.
void begin_lists(Cells c, OwnPatch own) {
  [[unroll]] for (int k = 0; k < 4; ++k) {
    const int i = 2 + k % 2, j = 2 + k / 2;
    uint p = (own.first_row + own.low.y + uint(k / 2)) * c.nx + own.low.x + uint(k % 2);
    if (!is_there(i, j)) continue;
    built_position[p] = real4(x_at(i, j), 0.0);
    pair_count[p] = surface_count[p] = 0u;
    surface_bound[p] = kInfinity;
  }
}

void look_at_patch(Cells c, OwnPatch own, inout Greatest most) {
  real3 low = x_at(2, 2), high = low;
  [[unroll]] for (int k = 0; k < 4; ++k) {  // at the cloth's end one of them again
    const int i = 2 + k % 2, j = 2 + k / 2;
    low = min(low, x_at(i, j));
    high = max(high, x_at(i, j));
    most.edge_squared = max(most.edge_squared, longest_edge(i, j));
  }
  begin_lists(c, own);
  patches[2u * own.patch_index] = real4(low, close() ? 0.0 : 1.0);
  patches[2u * own.patch_index + 1u] = real4(high, real(bends(c, own)));
}

// The block whose first patch this is: all its particles are around.
void look_at_block(Cells c, uint index, inout Greatest most) {
  real3 low = x_at(2, 2), high = low;
  [[unroll]] for (int k = 1; k < 16; ++k) {
    low = min(low, x_at(2 + k % 4, 2 + k / 4));
    high = max(high, x_at(2 + k % 4, 2 + k / 4));
  }
  blocks[2u * index] = real4(low, 0.0);
  blocks[2u * index + 1u] = real4(high, 0.0);
  precise real3 wide = high - low;
  if (covered(c, low) && covered(c, high)) most.side = max(most.side, max(max(wide.x, wide.y), wide.z));
  atomicAdd(cells[bucket_of(c, cell_of_box(c, low, high, index))], 1u);
}

uint block_index(Patches grid, OwnPatch own) {
  uvec2 blocks_each = blocks_of(grid);
  uint cloth = sheet_rows == 0u ? 0u : own.first_row / rows_of_cloth();
  return (cloth * blocks_each.y + own.low.y / 4u) * blocks_each.x + own.low.x / 4u;
}

void main() {
  if (collision_state[kListGroups] == 0u) return;
  Cells c = cells_of_cloth();
  Patches grid = patches_of(c);
  uint x = gl_GlobalInvocationID.x, begin = gl_GlobalInvocationID.y * rows;
  if (x >= grid.nx || begin >= grid.rows) return;
  Greatest most = Greatest(0.0, 0.0);
  uint end = min(begin + rows, grid.rows);
  choose_columns(patch_at(c, grid, x, begin));
  [[dont_unroll]] for (uint y = begin; y < end; ++y) {
    OwnPatch own = patch_at(c, grid, x, y);
    look_around(c, own, y > begin && own.low.y > 0u);
    look_at_patch(c, own, most);
    uvec2 at = own.low / 2u;
    if ((at.x & 1u) == 0u && (at.y & 1u) == 0u) look_at_block(c, block_index(grid, own), most);
  }
  raise(kLongestEdge, most.edge_squared);
  raise(kWidestBlock, most.side);
}
