// How far two lists of numbers are apart: largest difference, root mean square, units in the last place.
#pragma once
#include <cstdint>
#include <glm/vec4.hpp>
#include <span>

namespace weft {

struct Difference {
  double max_abs = 0, rms = 0;
  double bias = 0;            ///< largest component of the mean difference: what does not average out
  double magnitude = 0;       ///< largest absolute value expected
  std::uint64_t max_ulp = 0;  ///< numbers of the type of `got` between the two; −0 and +0 agree
  bool finite = true;         ///< whether every number on both sides is
};

/// @param got, expected  the same number of vectors; all four components count
Difference difference(std::span<const glm::vec4> got, std::span<const glm::vec4> expected);
Difference difference(std::span<const glm::dvec4> got, std::span<const glm::dvec4> expected);
/// The same against double; max_ulp counts floats to the nearest one.
Difference difference(std::span<const glm::vec4> got, std::span<const glm::dvec4> expected);

/// Steps from a to b, each to the next representable number; 0 for −0 and +0.
std::uint64_t ulp_between(float a, float b);
std::uint64_t ulp_between(double a, double b);

}  // namespace weft
