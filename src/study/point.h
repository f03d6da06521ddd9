// One point of a work-precision diagram: a setting, what it cost and how wrong it was.
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "study/trajectory.h"

namespace weft::study {

struct Point {
  Setting setting;
  std::uint32_t nx = 0, ny = 0;
  bool diverged = false;        ///< left the finite numbers, or further off than the cloth is large
  double error_m = 0;           ///< against the reference; infinite when diverged
  double ms_per_s = 0;          ///< milliseconds of the device per simulated second, the runs' median
  double ms_spread = 0;         ///< half the distance between the fastest and the slowest run
  std::uint32_t run_count = 0;  ///< warm, timed runs
  bool wall_clock = false;      ///< timed by the host's clock: the CPU, or a device without timestamps
  double springs_per_s = 0;     ///< spring evaluations per simulated second
  double springs_per_frame = 0;
  double max_stretch = 0, p99_stretch = 0;       ///< largest over output frames
  double momentum_error_m_s = 0;                 ///< of the centre of mass's velocity, largest over frames
  std::optional<double> energy_drift;            ///< undamped, over its scale; absent: not measured
  std::optional<double> equilibrium_distance_m;  ///< of the last frame; absent: the scene has none
};

/// Milliseconds of a frame of `frame_s`.
inline double ms_per_frame(const Point& point, double frame_s) { return point.ms_per_s * frame_s; }

nlohmann::ordered_json to_json(const Point& point);
/// @throws nlohmann::json::exception when a key is missing or of another kind
Point point_from_json(const nlohmann::ordered_json& json);

/// Header and one row a point, RFC 4180; numbers in their shortest exact form, absent ones empty.
std::string points_csv(const std::vector<Point>& points);

/// Whether the run is the reference itself: where halving its step helps no more, one of the sweep's may be.
inline bool is_reference(const Point& point) { return !point.diverged && !(point.error_m > 0.0); }

/// The points that no other of the same cloth beats in both cost and error, by rising cost (and so by falling
/// error). Diverged points are never on it, nor is the reference itself; of equal ones the first stays.
/// @param cost  what counts as cost
std::vector<const Point*> pareto_front(const std::vector<Point>& points, double (*cost)(const Point&));

inline double time_cost(const Point& point) { return point.ms_per_s; }
inline double spring_cost(const Point& point) { return point.springs_per_s; }

}  // namespace weft::study
