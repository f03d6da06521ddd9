#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Puts the particles that moving pins hold where the pins are when the row's drift ends, with their velocity.
// Each invocation writes a particle of its own and reads only tables: no races. A place is the sum of two
// numbers, never of many, so that nothing drifts.
// Source: docs/physics.md "Motion by keys"; docs/float-form.md "Pins that move".

READS (real4, substeps)
READS (MovedPin, moved_pins)
WRITES(real4, position)
WRITES(real4, velocity)

layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint row_index; };  // which row of the substep table

#include "../shared/moved_pins.glsl"

void main() {
  uint k = moved_pin_index();
  if (k >= moved_pins.length()) return;
  uint row = pin_row(row_index, moved_pins[k].pin), p = moved_pins[k].particle;
  if (substeps[row].w != 0.0) return;  // it has let go
  precise real3 x = moved_pins[k].anchor_m + substeps[row].xyz;
  position[p] = real4(x, 0.0);
  velocity[p] = real4(substeps[row + 1u].xyz, 0.0);
}
