#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Gives particles their mass back once their pin has let go; they keep place and velocity.
// Each invocation writes a particle of its own and reads only tables: no races.
// Source: docs/physics.md "Motion by keys"; docs/float-form.md "Pins that move".

READS (real4, substeps)
READS (MovedPin, moved_pins)
UPDATES(real4, position)

layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint row_index; };  // which row of the substep table

#include "../shared/moved_pins.glsl"
#include "../shared/sheets.glsl"

void main() {
  uint k = moved_pin_index();
  if (k >= moved_pins.length()) return;
  uint p = moved_pins[k].particle, i = p % params.nx, j = own_row(p / params.nx);
  real4 x = position[p];
  if (substeps[pin_row(row_index, moved_pins[k].pin)].w == 0.0 || x.w != 0.0) return;
  real w = i == 0u || i + 1u == params.nx ? 2.0 : 1.0;  // half the mass on a boundary line
  if (j == 0u || j + 1u == rows_of_cloth()) w = 2.0 * w;
  position[p] = real4(x.xyz, w);
}
