// Where everything of the work-precision diagram lies on the screen. Knows of no drawing, so that tests can
// ask it.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "study/chart_scale.h"
#include "study/series.h"
#include "study/study.h"

namespace weft {

/// A rectangle [screen units], y down.
struct PlotBox {
  float left = 0, top = 0, right = 0, bottom = 0;
};

struct PlotPlace {
  float x = 0, y = 0;
};

/// A measured point and where it is drawn.
struct PlotMark {
  study::Point point;
  PlotPlace place;
};

struct PlotLine {
  std::string solver, precision;
  std::vector<PlotMark> marks;  ///< by rising substeps
};

class DiagramLayout {
 public:
  static constexpr float kMargin = 20.0f;  ///< height above the plot, where diverged settings stand
  static constexpr double kRealTime_ms_per_s = 1000.0;

  /// @param nx             particles along the width; the study knows that cloth
  /// @param box            the axes, margin included
  /// @param live_ms_per_s  the running setting's time, which the axis then reaches
  DiagramLayout(const study::Study& study, std::uint32_t nx, const PlotBox& box,
                std::optional<double> live_ms_per_s);

  const PlotBox& box() const { return box_; }
  const std::vector<PlotLine>& lines() const { return lines_; }
  const std::vector<PlotPlace>& front() const { return front_; }
  const std::vector<study::Tick>& x_ticks() const { return x_ticks_; }
  const std::vector<study::Tick>& y_ticks() const { return y_ticks_; }
  /// Along the axes [screen units]; values beyond the ends come to lie beyond them.
  float x_at(double ms_per_s) const { return static_cast<float>(x_.at(ms_per_s)); }
  float y_at(double error_m) const { return static_cast<float>(y_.at(error_m)); }
  /// Whether real time is within the axis.
  bool shows_real_time() const { return x_.contains(kRealTime_ms_per_s); }
  /// The mark nearest to a place, at most `reach` away; nullptr when none is.
  const PlotMark* nearest(const PlotPlace& place, float reach) const;

 private:
  PlotBox box_;
  study::LogScale x_, y_;
  std::vector<PlotLine> lines_;
  std::vector<PlotPlace> front_;
  std::vector<study::Tick> x_ticks_, y_ticks_;
};

}  // namespace weft
