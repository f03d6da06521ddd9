// How deep particles are in what they may not be in, and which went through it: measures of hard cases.
#pragma once
#include <cstdint>

#include "model/model.h"

namespace weft::hard {

/// Deepest of a free particle inside a collider, over the collider's inner radius (half of what it is thick
/// at its thickest), or of any below the floor, over the cloth's width.
double deepest_share(const Model& model, const State& state);

/// Free particles whose way from one frame's end to the next, seen from a collider, leads through more than a
/// tenth of it, and those that are more than a millimetre below the floor. Only ways of less than a quarter
/// of its inner radius count, which is more than any case moves in a frame of its own: on a surface so short
/// a chord is 0.8 % deep in a sphere, and 9 % deep across the edge of a box.
std::uint32_t passed_through(const Model& model, const State& before, const State& after);

}  // namespace weft::hard
