// The end of a run that has diverged: its message, and the last good state in a file.
#pragma once
#include <filesystem>
#include <optional>

#include "sim/simulation.h"

namespace weft::cli {

/// Where the last good state of a run with `--out` goes: run.csv -> run.last-good.csv.
std::filesystem::path last_good_file(const std::filesystem::path& out);

/// Does nothing while the simulation is sound. Otherwise saves the last good state beside `out`, where there
/// is one, whole or not at all.
/// @throws Error(Exit::diverged) naming frame, particle, likely cause and file
void stop_if_diverged(Simulation& simulation, const std::optional<std::filesystem::path>& out);

}  // namespace weft::cli
