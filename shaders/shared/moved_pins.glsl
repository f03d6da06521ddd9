// Where the passes over the particles of moving pins find theirs and its row of the substep table.

uint moved_pin_index() { return gl_GlobalInvocationID.y * kMovedPinsWide + gl_GlobalInvocationID.x; }

uint pin_row(uint row_index, uint pin) {
  return row_index * params.row_stride + kRowHeadVec4s + kRowSphereVec4s * params.sphere_count +
         kRowPinVec4s * pin;
}
