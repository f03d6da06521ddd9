// How far the device may stray from the reference, and the verdict on one comparison of `validate`.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/compare.h"
#include "sim/validate.h"

namespace weft {

/// How far a device that rounds otherwise may stray from the float mirror.
struct Allowance {
  double max_abs = 0, rms = 0, bias = 0;
};

/// @param lost   the float mirror against the double mirror: what rounding costs on this work
/// @param count  vectors in the buffer
/// @param held   pinned particles: the springs to them have no partner whose error cancels theirs, so that
/// the
///               mean may be off by the largest error at each
/// A division of 2.5 ulp and a root of 3 (Vulkan's limits) are some ten times the half ulp of the mirrors'.
/// Where float is exact by luck, an ulp of the largest number remains. Double loses on the same work what
/// float does, a rounding of 2^-53 for each of 2^-24.
template <class T>
Allowance allowance(const Difference& lost, std::size_t count, std::size_t held);

/// Fills in the verdict of a comparison from its difference; without an allowance it must be exact.
void give_verdict(ValidationRow& row, const Difference& apart, const std::optional<Allowance>& allowed);

/// Integers must be equal on every device.
void judge_words(ValidationRow& row, const std::vector<std::uint32_t>& got,
                 const std::vector<std::uint32_t>& expected);

}  // namespace weft
