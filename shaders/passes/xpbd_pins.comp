#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// How far moving pins take their particles in this substep, so that the springs pull on where they will be.
// Each invocation writes a particle of its own and reads only tables: no races.
// Source: docs/physics.md "Motion by keys"; docs/float-form.md "Pins that move".

READS (real4, substeps)
READS (MovedPin, moved_pins)
WRITES(real4, position_next)

layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint row_index; };  // which row of the substep table

#include "../shared/moved_pins.glsl"

void main() {
  uint k = moved_pin_index();
  if (k >= moved_pins.length()) return;
  uint row = pin_row(row_index, moved_pins[k].pin);
  if (substeps[row].w != 0.0) return;  // it has let go
  precise real3 moved = substeps[row_index * params.row_stride + 1u].y * substeps[row + 1u].xyz;
  position_next[moved_pins[k].particle] = real4(moved, 0.0);
}
