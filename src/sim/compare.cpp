// How far two lists of numbers are apart.
#include "sim/compare.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <type_traits>

namespace weft {
namespace {

/// Numbers in ascending order as consecutive integers, both zeros at 0.
template <class T>
std::int64_t ordered(T value) {
  using Word = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
  constexpr Word kSign = Word{1} << (8 * sizeof(T) - 1);
  const auto bits = std::bit_cast<Word>(value);
  const auto magnitude = static_cast<std::int64_t>(bits & ~kSign);
  return (bits & kSign) != 0 ? -magnitude : magnitude;
}

template <class T>
std::uint64_t steps_between(T a, T b) {
  const std::int64_t i = ordered(a), k = ordered(b);
  const auto difference = static_cast<std::uint64_t>(i) - static_cast<std::uint64_t>(k);  // may exceed int64
  return i >= k ? difference : 0 - difference;
}

template <class G, class E>
Difference compare(std::span<const glm::vec<4, G>> got, std::span<const glm::vec<4, E>> expected) {
  Difference result;
  double squares = 0;
  glm::dvec4 sum(0.0);
  for (std::size_t p = 0; p < expected.size(); ++p)
    for (int c = 0; c < 4; ++c) {
      const G a = got[p][c];
      const E b = expected[p][c];
      if (!std::isfinite(a) || !std::isfinite(b)) {
        result.finite = false;
        continue;
      }
      const double apart = double{a} - double{b};
      result.max_abs = std::max(result.max_abs, std::abs(apart));
      result.magnitude = std::max(result.magnitude, std::abs(double{b}));
      result.max_ulp = std::max(result.max_ulp, ulp_between(a, static_cast<G>(b)));
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

std::uint64_t ulp_between(float a, float b) { return steps_between(a, b); }
std::uint64_t ulp_between(double a, double b) { return steps_between(a, b); }

Difference difference(std::span<const glm::vec4> got, std::span<const glm::vec4> expected) {
  return compare(got, expected);
}

Difference difference(std::span<const glm::dvec4> got, std::span<const glm::dvec4> expected) {
  return compare(got, expected);
}

Difference difference(std::span<const glm::vec4> got, std::span<const glm::dvec4> expected) {
  return compare(got, expected);
}

}  // namespace weft
