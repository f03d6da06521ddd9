// The work-precision diagram: error against cost, both logarithmic, one line a solver and precision.
#pragma once
#include <string>

#include "study/study.h"

namespace weft::study {

enum class CostAxis { device_time, spring_evaluations };

/// One resolution's diagram as an SVG document: the front of what nothing beats, real time, the floors
/// shaded, diverged settings in the margin above, device and date named. Colours are those of Okabe and Ito,
/// told apart by everyone; markers and dashes say the same without colour.
std::string work_precision_svg(const Study& study, std::uint32_t nx, CostAxis axis);

}  // namespace weft::study
