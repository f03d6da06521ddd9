// Several cloths in one set of buffers: each has the same number of rows, one cloth's below another's, and no
// pair of particles joins two. A scene of one cloth leaves the constant alone and pays for nothing here.
layout(constant_id = 30) const uint sheet_rows = 0u;  // of each cloth; 0: there is one

uint rows_of_cloth() { return sheet_rows == 0u ? params.ny : sheet_rows; }

bool same_cloth(uint row_a, uint row_b) {
  return sheet_rows == 0u || row_a / sheet_rows == row_b / sheet_rows;
}

// Which cloth a row is of. Where there is but one, no device is to divide: some do it lane by lane.
uint cloth_of(uint j) { return sheet_rows == 0u ? 0u : j / sheet_rows; }

// The row within its own cloth.
uint own_row(uint j) { return sheet_rows == 0u ? j : j % sheet_rows; }
