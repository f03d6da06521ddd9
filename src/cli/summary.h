// The line (or object) that sums up a run: which device, how long, how fast, how far the cloth stretched.
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "cli/setup.h"
#include "sim/expect.h"

namespace weft::cli {

/// What a run leaves behind.
struct Outcome {
  State state;
  double wall_s = 0.0;
  std::uint64_t spring_evaluations = 0;
  FrameStats frame;               ///< of the first frame
  std::vector<Verdict> verdicts;  ///< of `simulate --check`
};

/// The fields of `simulate --format json`, in their documented order.
nlohmann::ordered_json summarize(const Setup&, const Machine&, const Outcome&);

/// Prints one line for people, one object as JSON, or a header and a row as CSV.
/// @param tail  more for people, put at the line's end
void print_summary(const Options&, const Scene&, const nlohmann::ordered_json& fields,
                   const std::string& tail = {});

}  // namespace weft::cli
