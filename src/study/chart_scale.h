// A logarithmic axis: what it spans, where a value lies on it, and its ticks.
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace weft::study {

struct Tick {
  double value;
  std::string label;
  bool major;
};

class LogScale {
 public:
  /// @param from, to  picture coordinates of the smallest and the largest value
  LogScale(double from, double to) : from_(from), to_(to) {}

  /// Stretches the axis over a value; what is not positive and finite has no place on it.
  void include(double value) {
    if (!(value > 0.0) || !std::isfinite(value)) return;
    low_ = std::min(low_, std::log10(value));
    high_ = std::max(high_, std::log10(value));
  }
  /// Leaves `decades` free at both ends, and gives an axis that spans less than one decade that much.
  void widen(double decades) {
    if (low_ > high_) low_ = -1.0, high_ = 0.0;
    const double lacking = std::max(0.0, 1.0 - (high_ - low_));
    low_ -= decades + 0.5 * lacking;
    high_ += decades + 0.5 * lacking;
  }
  bool contains(double value) const { return within(value, 0.0); }
  /// Whether a value lies at most `decades` beyond the ends.
  bool within(double value, double decades) const {
    return std::log10(value) >= low_ - decades && std::log10(value) <= high_ + decades;
  }
  double at(double value) const {
    return from_ + (to_ - from_) * (std::log10(value) - low_) / (high_ - low_);
  }

  /// Decades, and 2 to 9 between them unless there are many; 2 and 5 bear labels on a short axis.
  std::vector<Tick> ticks() const {
    std::vector<Tick> list;
    const bool is_short = high_ - low_ < 2.2;
    for (int decade = static_cast<int>(std::floor(low_)); decade <= static_cast<int>(high_) + 1; ++decade)
      for (int m = 1; m <= 9; ++m) {
        const double value = m * std::pow(10.0, decade);
        if (!contains(value) || (m > 1 && high_ - low_ > 4.5)) continue;
        list.push_back({value, label(m, decade), m == 1 || (is_short && (m == 2 || m == 5))});
      }
    return list;
  }

 private:
  static std::string label(int m, int decade) {
    if (decade >= -1 && decade <= 4) return fmt::format("{:g}", m * std::pow(10.0, decade));
    return fmt::format("{}e{}", m, decade);
  }
  double from_, to_, low_ = 1e300, high_ = -1e300;
};

}  // namespace weft::study
