// Reading and checking the keys of a motion.
#include "scene/motion_keys.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>

#include "core/error.h"
#include "core/text.h"

namespace weft {
namespace {

constexpr double kLatest_s = 1e6;
constexpr std::size_t kMotionKeysMax = 10000;

std::string broken_key(const Parameter& parameter, const MotionKey& key) {
  if (!(key.time_s >= 0.0 && key.time_s <= kLatest_s))
    return fmt::format("time is {}; it must be 0 to {}, in s (0 is the start)", short_number(key.time_s),
                       short_number(kLatest_s));
  for (int axis = 0; axis < 3; ++axis)
    if (const double c = key.place_m[axis]; !(c >= parameter.minimum && c <= parameter.maximum))
      return fmt::format("{} is {}; it must be three numbers, each {} to {}, in m ([0, 1, 0])",
                         motion_place_name(parameter), value_text(ParameterValue(key.place_m)),
                         short_number(parameter.minimum), short_number(parameter.maximum));
  for (int axis = 0; axis < 3; ++axis)
    if (!(std::abs(key.rotation_deg[axis]) <= kTurnFarthest_deg))
      return fmt::format("rotation is {}; it must be three numbers, each {} to {}, in degrees ([0, 90, 0])",
                         value_text(ParameterValue(key.rotation_deg)), short_number(-kTurnFarthest_deg),
                         short_number(kTurnFarthest_deg));
  return {};
}

std::string broken_step(const MotionKey& from, const MotionKey& to) {
  const double taken_s = to.time_s - from.time_s;
  if (!(taken_s > 0.0))
    return fmt::format("time is {}; it must be later than the key before, {} (order the keys by time)",
                       short_number(to.time_s), short_number(from.time_s));
  const double speed_m_s = glm::distance(from.place_m, to.place_m) / taken_s;
  if (!(speed_m_s <= kMotionFastest_m_s * (1.0 + 1e-9)))
    return fmt::format(
        "time is {}, {} s after the key before: that is {} m/s; it must be at most {} m/s (give "
        "the way more time)",
        short_number(to.time_s), short_number(taken_s), short_number(speed_m_s),
        short_number(kMotionFastest_m_s));
  for (int axis = 0; axis < 3; ++axis) {
    const double turn_deg_s = std::abs(to.rotation_deg[axis] - from.rotation_deg[axis]) / taken_s;
    if (!(turn_deg_s <= kTurnFastest_deg_s * (1.0 + 1e-9)))
      return fmt::format(
          "time is {}, {} s after the key before: that is {} degrees a second about an axis; it must be at "
          "most {} (give the turn more time)",
          short_number(to.time_s), short_number(taken_s), short_number(turn_deg_s),
          short_number(kTurnFastest_deg_s));
  }
  return {};
}

/// The numbers of `node`, as many as there are; nothing when something else stands there.
std::vector<double> numbers_of(const toml::node* node) {
  std::vector<double> numbers;
  if (node == nullptr) return numbers;
  if (node->is_number()) return {node->value<double>().value_or(0.0)};
  if (const toml::array* list = node->as_array())
    for (const toml::node& number : *list) {
      if (!number.is_number()) return {};
      numbers.push_back(number.value<double>().value_or(0.0));
    }
  return numbers;
}

}  // namespace

std::string_view motion_place_name(const Parameter& parameter) {
  return parameter.section == "pins" ? "offset" : "center";
}

bool motion_turns(const Parameter& parameter) {
  return parameter.section != "pins" && parameter.section != "spheres";
}

std::string broken_motion(const Parameter& parameter, const MotionKeys& keys) {
  if (keys.empty() || keys.size() > kMotionKeysMax)
    return fmt::format(" has {} keys; it must be 1 to {} (remove the key `keys` for what does not move)",
                       keys.size(), kMotionKeysMax);
  for (std::size_t k = 0; k < keys.size(); ++k) {
    std::string mistake = broken_key(parameter, keys[k]);
    if (mistake.empty() && k > 0) mistake = broken_step(keys[k - 1], keys[k]);
    if (!mistake.empty()) return fmt::format(".{}.{}", k, mistake);
  }
  return {};
}

MotionKeys read_motion(const Parameter& parameter, const std::string& name, const toml::node& node,
                       const Place& place) {
  const toml::array* items = node.as_array();
  if (items == nullptr || !(items->empty() || items->is_homogeneous<toml::table>()))
    throw error(Exit::usage, "{}: {} is {}; it must be {} ({})", place, name, node_text(node),
                rule_text(parameter), parameter.example);
  const std::string_view at = motion_place_name(parameter), known[] = {"time", at, "rotation"};
  const std::span allowed(known, motion_turns(parameter) ? 3 : 2);
  MotionKeys keys;
  for (std::size_t k = 0; k < items->size(); ++k) {
    const toml::table& item = *items->get(k)->as_table();
    for (const auto& [key, value] : in_file_order(item))
      if (std::ranges::find(allowed, key->str()) == allowed.end())
        throw error(Exit::usage, "{}: {} is not a key of {}.{}; {}", place, in_quotes(key->str()), name, k,
                    suggestion(key->str(), allowed));
    const std::vector<double> time = numbers_of(item.get("time")), numbers = numbers_of(item.get(at));
    const bool has_time = time.size() == 1 && item.get("time")->is_number();
    if (!has_time || numbers.size() != 3)
      throw error(Exit::usage, "{}: {}.{} has no {}; it must be {{ time = s, {} = [x, y, z] }} ({})", place,
                  name, k, has_time ? at : "time", at, parameter.example);
    MotionKey read{time[0], {numbers[0], numbers[1], numbers[2]}};
    if (const toml::node* turn = item.get("rotation")) {
      const std::vector<double> angles = numbers_of(turn);
      if (angles.size() != 3)
        throw error(Exit::usage, "{}: {}.{}.rotation is {}; it must be [x, y, z], in degrees ([0, 90, 0])",
                    place, name, k, node_text(*turn));
      read.rotation_deg = {angles[0], angles[1], angles[2]};
    }
    keys.push_back(read);
  }
  if (const std::string mistake = broken_motion(parameter, keys); !mistake.empty())
    throw error(Exit::usage, "{}: {}{}", place, name, mistake);
  return keys;
}

}  // namespace weft
