// Patches of 2 x 2 particles of one cloth, and blocks of 2 x 2 patches. Blocks are what the grid holds, and
// only the particles of patches that have another near look for more than their neighbours.
// docs/float-form.md "Patches". The including pass includes cells.glsl first.

struct Patches {
  uint nx, ny, rows;  // of one cloth; of all
};

Patches patches_of(Cells c) {
  uint ny = (rows_of_cloth() + 1u) / 2u;
  return Patches((c.nx + 1u) / 2u, ny, (sheet_rows == 0u ? 1u : c.ny / sheet_rows) * ny);
}

// Where this invocation's patch is.
struct OwnPatch {
  uint x, y, patch_index;
  uint first_row;   // of its cloth
  uvec2 low, last;  // its first particle, and the last of the cloth, within the cloth
};

OwnPatch patch_at(Cells c, Patches grid, uint x, uint y) {
  uint cloth = sheet_rows == 0u ? 0u : y / grid.ny;
  return OwnPatch(x, y, y * grid.nx + x, cloth * rows_of_cloth(), 2u * uvec2(x, y - cloth * grid.ny),
                  uvec2(c.nx, rows_of_cloth()) - 1u);
}

// Two by two patches: columns and rows of patches, both ends included.
struct Block {
  uvec2 low, high;
  uint first_row;  // of patches, of their cloth
};

// How many blocks side by side, and one above the other on each cloth.
uvec2 blocks_of(Patches grid) { return (uvec2(grid.nx, grid.ny) + 1u) / 2u; }

Block block_at(Patches grid, uvec2 at) {
  uint down = blocks_of(grid).y, cloth = sheet_rows == 0u ? 0u : at.y / down, first_row = cloth * grid.ny;
  uvec2 low = uvec2(2u * at.x, first_row + 2u * (at.y - cloth * down));
  return Block(low, min(low + 1u, uvec2(grid.nx, first_row + grid.ny) - 1u), first_row);
}

// Of all cloths.
uint block_rows(Patches grid) {
  return sheet_rows == 0u ? blocks_of(grid).y : grid.rows / grid.ny * blocks_of(grid).y;
}

bool own_block_index(Patches grid, out uint index) {
  uint x = gl_GlobalInvocationID.x, y = gl_GlobalInvocationID.y, across = blocks_of(grid).x;
  index = y * across + x;
  return x < across && y < block_rows(grid);
}

// The patch that a particle is in.
uint patch_with(Patches grid, Own own) {
  uint j = own_row(own.j);
  return (cloth_of(own.j) * grid.ny + j / 2u) * grid.nx + own.i / 2u;
}

// The cell that a box's middle is in; one of its own where the grid does not cover the box.
ivec3 cell_of_box(Cells c, real3 low, real3 high, uint block_index) {
  if (!covered(c, low) || !covered(c, high)) return ivec3(int(block_index), 0x40000000, 0x40000000);
  precise real3 middle = 0.5 * (low + high);
  precise real3 scaled = floor(middle * c.inverse_cell_1_m);
  return ivec3(scaled);
}

// The first particle of a patch: column and row.
uvec2 corner_of(Patches grid, uint patch_index) {
  uint x = patch_index % grid.nx, y = patch_index / grid.nx, cloth = y / grid.ny;
  return uvec2(2u * x, cloth * rows_of_cloth() + 2u * (y - cloth * grid.ny));
}

// The last particle of the patch whose first is `low`.
uvec2 far_corner_of(Cells c, uvec2 low) {
  uint last_row = (low.y / rows_of_cloth() + 1u) * rows_of_cloth() - 1u;
  return min(low + 1u, uvec2(c.nx - 1u, last_row));
}
