// Where something is between its keys.
#include "model/motion.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace weft {

namespace {

glm::dvec3 between_keys(const MotionKeys& keys, double time_s, glm::dvec3 MotionKey::*what) {
  const auto next = std::ranges::upper_bound(keys, time_s, {}, &MotionKey::time_s);
  if (next == keys.begin()) return keys.front().*what;
  if (next == keys.end()) return keys.back().*what;
  const MotionKey &from = *(next - 1), &to = *next;
  const double share = (time_s - from.time_s) / (to.time_s - from.time_s);
  return from.*what + share * (to.*what - from.*what);
}

}  // namespace

glm::dvec3 place_at(const MotionKeys& keys, double time_s) {
  return between_keys(keys, time_s, &MotionKey::place_m);
}

glm::dvec3 rotation_at(const MotionKeys& keys, double time_s) {
  return between_keys(keys, time_s, &MotionKey::rotation_deg);
}

glm::dvec3 velocity_before(const MotionKeys& keys, double time_s) {
  const auto next = std::ranges::lower_bound(keys, time_s, {}, &MotionKey::time_s);
  if (next == keys.begin() || next == keys.end()) return glm::dvec3(0.0);
  const MotionKey &from = *(next - 1), &to = *next;
  return (to.place_m - from.place_m) / (to.time_s - from.time_s);
}

double fastest_m_s(const MotionKeys& keys) {
  double fastest = 0.0;
  for (std::size_t k = 1; k < keys.size(); ++k)
    fastest = std::max(
        fastest, glm::distance(keys[k].place_m, keys[k - 1].place_m) / (keys[k].time_s - keys[k - 1].time_s));
  return fastest;
}

}  // namespace weft
