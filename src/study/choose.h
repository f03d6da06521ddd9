// Choosing a setting from measured points: the cheapest for an error, the most accurate for a frame time.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "study/point.h"

namespace weft::study {

/// The cheapest point whose measured error is below the wish; nothing when none reaches it. Of equally cheap
/// ones the more accurate. A larger wish leaves more points to choose from, so it never costs more.
/// @param points  of one cloth on one device
std::optional<Point> choose_for_error(const std::vector<Point>& points, double error_m);

/// The most accurate point whose frame takes at most `budget_ms`; nothing when even the cheapest does not
/// fit. Of equally accurate ones the cheaper. A larger budget never is less accurate.
std::optional<Point> choose_for_budget(const std::vector<Point>& points, double budget_ms, double frame_s);

/// The most accurate and the cheapest that did not diverge; nothing without any.
std::optional<Point> most_accurate(const std::vector<Point>& points);
std::optional<Point> cheapest(const std::vector<Point>& points);

}  // namespace weft::study
