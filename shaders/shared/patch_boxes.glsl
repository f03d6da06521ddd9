// The boxes of patches, for passes that declare READS_VECTORS(patches). The including pass includes
// patches.glsl first.

real3 patch_low(uint patch_index) { return load_patches(2u * patch_index).xyz; }
real3 patch_high(uint patch_index) { return load_patches(2u * patch_index + 1u).xyz; }

// Which of its cells are folded, and kCreased.
uint folds_in(uint patch_index) { return uint(load_patches(2u * patch_index + 1u).w); }

ivec3 cell_of_patch(Cells c, uint patch_index) {
  return cell_of_box(c, patch_low(patch_index), patch_high(patch_index), patch_index);
}

// Whether some point of the box may be within `search` of x.
bool box_reaches(uint patch_index, real3 x, real search) {
  precise real3 before = patch_low(patch_index) - x, after = x - patch_high(patch_index);
  real3 gap = max(before, after);
  return max(max(gap.x, gap.y), gap.z) < search;
}
