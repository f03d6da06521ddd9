// Numbers in JSON, which has no word for what is not finite: null stands for infinity.
#pragma once
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace weft::study {

inline nlohmann::ordered_json json_of(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

/// @throws nlohmann::json::type_error when it is neither a number nor null
inline double number_of(const nlohmann::ordered_json& value) {
  return value.is_null() ? std::numeric_limits<double>::infinity() : value.get<double>();
}

}  // namespace weft::study
