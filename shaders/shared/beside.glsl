// The eight particles round one on the cloth. The including pass includes cells.glsl first.

const uint kBesideCount = 8u;

// Row by row, without the middle.
ivec2 beside_offset(uint k) {
  uint place = k < 4u ? k : k + 1u;
  return ivec2(int(place % 3u), int(place / 3u)) - 1;
}

bool has_beside(Cells c, Own own, uint k) {
  ivec2 at = ivec2(own.i, own_row(own.j)) + beside_offset(k);
  return at.x >= 0 && at.y >= 0 && at.x < int(c.nx) && at.y < int(rows_of_cloth());
}

uvec2 beside_at(Own own, uint k) { return uvec2(ivec2(own.i, own.j) + beside_offset(k)); }

// Whether a particle, by column and row, is one of them, or the one itself.
bool beside(Own own, uvec2 other) {
  ivec2 off = abs(ivec2(other) - ivec2(own.i, own.j));
  return off.x <= 1 && off.y <= 1 && same_cloth(other.y, own.j);
}
