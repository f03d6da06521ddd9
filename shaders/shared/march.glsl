// The main of the explicit passes: an invocation marches down `rows` particles of a column, on the next cloth
// where one ends. The including
// pass defines move(), which does one particle; it includes held_params.glsl, force.glsl and kick.glsl
// first.
void move(Step s, Column c, inout March m);

void main() {
#ifdef WEFT_REACH
  if (is_torn()) return;
#endif
  hold_params();
  uint i = gl_GlobalInvocationID.x, first = gl_GlobalInvocationID.y * rows;
  if (i >= params.nx || first >= params.ny) return;
  Step s = step_of(row_index * params.row_stride);
  Column c = column_at(i);
  March m = march_from(c, first);
  uint last = min(first + rows, params.ny) - 1u;
  for (uint row = first;; ++row) {
    move(s, c, m);
    if ((sheet_rows == 0u ? m.j : row) >= last) break;
    if (sheet_rows != 0u && m.j + 1u == c.ny)
      m = march_from(c, row + 1u);
    else
      step_down(c, m);
  }
#ifdef WEFT_REACH
  tell_reach();
#endif
#ifdef WEFT_SPREAD
  tell_kicks();
#endif
}
