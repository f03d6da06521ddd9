// Carries a running cloth over to another model: another resolution, size, place or set of pins.
#pragma once
#include "model/model.h"

namespace weft {

/// The state of `to` that continues `state` of `from`. Displacement from the start and velocity are
/// interpolated over the flat cloth (bicubic, in fractions of width and height), so that the shape stays
/// whatever the grid; where grid and start agree they are copied. A particle that `to` pins moves with the
/// nearest one that `from` pinned (an untouched pin ends exactly on its place) and rests.
/// @return positions [m], velocities [m/s], time of `state`
State carry_state(const Model& from, const State& state, const Model& to);

}  // namespace weft
