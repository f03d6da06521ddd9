// The boxes of patches, for passes that declare READS_VECTORS(patches). The including pass includes
// block_boxes.glsl first.

real3 patch_low(uint patch_index) { return load_patches(2u * patch_index).xyz; }
real3 patch_high(uint patch_index) { return load_patches(2u * patch_index + 1u).xyz; }

// Which of its cells are folded, and kCreased.
uint folds_in(uint patch_index) { return uint(load_patches(2u * patch_index + 1u).w); }

// Whether some point of the patch's box may be within `search` of x.
bool patch_reaches(uint patch_index, real3 x, real search) {
  return gap_between(patch_low(patch_index), patch_high(patch_index), x, x) < search;
}
