// How far the device may stray from the reference, and the verdict on one comparison of `validate`.
#include "sim/allowance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace weft {

template <class T>
Allowance allowance(const Difference& lost, std::size_t count, std::size_t held) {
  constexpr double kUlp = std::numeric_limits<float>::epsilon();
  constexpr double kScale = std::numeric_limits<T>::epsilon() / kUlp, kMax = 16 * kScale, kRms = 8 * kScale;
  const double n = static_cast<double>(count), ulp = kScale * kUlp * lost.magnitude;
  const double at_pins = kMax * lost.max_abs * static_cast<double>(held) / n;
  return {.max_abs = kMax * lost.max_abs + ulp,
          .rms = kRms * lost.rms + ulp,
          .bias = (kRms * lost.rms + ulp) / std::sqrt(n) + at_pins + kScale * lost.bias};
}

template Allowance allowance<float>(const Difference&, std::size_t, std::size_t);
template Allowance allowance<double>(const Difference&, std::size_t, std::size_t);

void give_verdict(ValidationRow& row, const Difference& apart, const std::optional<Allowance>& allowed) {
  row.max_abs = apart.max_abs;
  row.rms = apart.rms;
  row.bias = apart.bias;
  row.max_ulp = apart.max_ulp;
  row.tolerance = allowed ? allowed->max_abs : 0;
  const bool near =
      allowed ? apart.max_abs <= allowed->max_abs && apart.rms <= allowed->rms : apart.max_ulp == 0;
  const bool biased = allowed && apart.bias > allowed->bias;
  row.ok = apart.finite && near && !biased;
  if (!apart.finite)
    row.verdict = "not finite";
  else if (!near)
    row.verdict = "over tolerance";
  else if (biased)
    row.verdict = "biased";
  else
    row.verdict = apart.max_ulp == 0 ? "exact" : "within tolerance";
}

void judge_words(ValidationRow& row, const std::vector<std::uint32_t>& got,
                 const std::vector<std::uint32_t>& expected) {
  for (std::size_t k = 0; k < std::min(got.size(), expected.size()); ++k)
    row.max_abs =
        std::max(row.max_abs, std::abs(static_cast<double>(got[k]) - static_cast<double>(expected[k])));
  row.ok = got == expected;
  row.verdict = row.ok ? "exact" : "over tolerance";
}

}  // namespace weft
