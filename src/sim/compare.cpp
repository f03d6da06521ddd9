// How far two lists of floats are apart.
#include "sim/compare.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>

namespace weft {
namespace {

/// Floats in ascending order as consecutive integers, both zeros at 0.
std::int64_t ordered(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const auto magnitude = static_cast<std::int64_t>(bits & 0x7fffffffu);
  return (bits >> 31) != 0 ? -magnitude : magnitude;
}

template <class T>
Difference compare(std::span<const glm::vec4> got, std::span<const glm::vec<4, T>> expected) {
  Difference result;
  double squares = 0;
  glm::dvec4 sum(0.0);
  for (std::size_t p = 0; p < expected.size(); ++p)
    for (int c = 0; c < 4; ++c) {
      const float a = got[p][c];
      const T b = expected[p][c];
      if (!std::isfinite(a) || !std::isfinite(b)) {
        result.finite = false;
        continue;
      }
      const double apart = double{a} - double{b};
      result.max_abs = std::max(result.max_abs, std::abs(apart));
      result.magnitude = std::max(result.magnitude, std::abs(double{b}));
      result.max_ulp = std::max(result.max_ulp, ulp_between(a, static_cast<float>(b)));
      squares += apart * apart;
      sum[c] += apart;
    }
  if (expected.empty()) return result;
  const double count = static_cast<double>(expected.size());
  result.rms = std::sqrt(squares / (4.0 * count));
  for (int c = 0; c < 4; ++c) result.bias = std::max(result.bias, std::abs(sum[c]) / count);
  return result;
}

}  // namespace

std::uint64_t ulp_between(float a, float b) {
  return static_cast<std::uint64_t>(std::llabs(ordered(a) - ordered(b)));
}

Difference difference(std::span<const glm::vec4> got, std::span<const glm::vec4> expected) {
  return compare<float>(got, expected);
}

Difference difference(std::span<const glm::vec4> got, std::span<const glm::dvec4> expected) {
  return compare<double>(got, expected);
}

}  // namespace weft
