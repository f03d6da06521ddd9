// The boxes of blocks, for passes that declare READS_VECTORS(blocks). The including pass includes
// patches.glsl first.

real3 block_low(uint block_index) { return load_blocks(2u * block_index).xyz; }
real3 block_high(uint block_index) { return load_blocks(2u * block_index + 1u).xyz; }

ivec3 cell_of_block(Cells c, uint block_index) {
  return cell_of_box(c, block_low(block_index), block_high(block_index), block_index);
}

// The largest gap between two boxes along an axis; less than 0 where they overlap.
real gap_between(real3 low_a, real3 high_a, real3 low_b, real3 high_b) {
  precise real3 before = low_a - high_b, after = low_b - high_a;
  real3 gap = max(before, after);
  return max(max(gap.x, gap.y), gap.z);
}

// Whether some point of the block's box may be within `search` of x.
bool block_reaches(uint block_index, real3 x, real search) {
  return gap_between(block_low(block_index), block_high(block_index), x, x) < search;
}
