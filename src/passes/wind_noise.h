// Wind that differs from place to place, as docs/float-form.md "Wind noise": hashed vectors on a lattice of
// space and time, smooth between.
#pragma once
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>

#include "passes/coefficients.h"

namespace weft {

/// Of one lattice point and slice of time: components in (−1, 1).
template <class T>
glm::vec<3, T> lattice_vector(const glm::ivec3& at, std::uint32_t slice, std::uint32_t seed) {
  const auto wrapped = [](int cell) { return std::uint32_t(cell & shared::kNoisePeriodMask); };
  std::uint32_t h = (wrapped(at.x) * 0x8da6b343u) ^ (wrapped(at.y) * 0xd8163841u) ^
                    (wrapped(at.z) * 0xcb1ab31fu) ^ (slice * 0x165667b1u) ^ (seed * 0x9e3779b1u);
  h = (h ^ (h >> 16)) * 0x85ebca6bu;
  h = (h ^ (h >> 13)) * 0xc2b2ae35u;
  h ^= h >> 16;
  const auto component = [&](unsigned shift) { return (T((h >> shift) & 1023u) - T(511.5)) / T(512); };
  return {component(0), component(10), component(20)};
}

/// @param at, share  lattice cell, and the smoothed place in it
template <class T>
glm::vec<3, T> noise_in_slice(const glm::ivec3& at, const glm::vec<3, T>& share, std::uint32_t slice,
                              std::uint32_t seed) {
  using V = glm::vec<3, T>;
  const auto blend = [](const V& a, const V& b, T part) { return a + part * (b - a); };
  const auto along_x = [&](int y, int z) {
    return blend(lattice_vector<T>(at + glm::ivec3(0, y, z), slice, seed),
                 lattice_vector<T>(at + glm::ivec3(1, y, z), slice, seed), share.x);
  };
  const auto along_y = [&](int z) { return blend(along_x(0, z), along_x(1, z), share.y); };
  return blend(along_y(0), along_y(1), share.z);
}

/// Between −1 and 1 in each component.
template <class T>
glm::vec<3, T> wind_noise(const AirRow<T>& air, const glm::vec<3, T>& x, std::uint32_t seed) {
  glm::ivec3 cell;
  glm::vec<3, T> share;
  for (int k = 0; k < 3; ++k) {
    T q = x[k] * air.cells_1_m - air.origin[k];
    if (!(std::abs(q) < static_cast<T>(shared::kNoiseFarthest))) q = T(0);
    const T low = std::floor(q), t = q - low;
    cell[k] = static_cast<int>(low);
    share[k] = (t * t) * (T(3) - T(2) * t);
  }
  const auto slice = static_cast<std::uint32_t>(air.slice);
  const glm::vec<3, T> now = noise_in_slice(cell, share, slice, seed);
  const glm::vec<3, T> next = noise_in_slice(cell, share, slice + 1, seed);
  return now + air.slice_share * (next - now);
}

}  // namespace weft
