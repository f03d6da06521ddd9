// The work-precision diagram drawn with ImGui's lists, on light paper in the report's colours and markers.
#pragma once
#include <optional>
#include <string>

#include "study/study.h"

namespace weft {

/// The running setting's place in the diagram.
struct LiveDot {
  std::optional<double> ms_per_s;  ///< nothing: not measured yet
  std::optional<double> error_m;   ///< nothing: the study does not tell
  std::string name;                ///< for the tooltip
};

/// Draws it at the cursor with a legend below, `width` × `height` [screen units] without the legend, and says
/// under the mouse what a point is.
/// @param nx  the study knows that cloth
/// @return  the setting that was clicked on
std::optional<study::Setting> draw_diagram(const study::Study& study, std::uint32_t nx, const LiveDot& live,
                                           float width, float height);

/// A point in words: solver, precision, substeps, error, time; one fact a line.
std::string point_text(const study::Point& point, double frame_s);

}  // namespace weft
