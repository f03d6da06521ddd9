// Saves what was good, then says what went wrong.
#include "cli/divergence.h"

#include "cli/text.h"
#include "core/error.h"
#include "core/text.h"
#include "model/state_io.h"

namespace weft::cli {
namespace {

/// What became of the last good state, as the end of the message says it. A file that cannot be written does
/// not hide the divergence.
std::string save_last_good(Simulation& simulation, const std::optional<std::filesystem::path>& out) {
  const std::optional<State> state = simulation.last_good();
  if (!state) return {};
  if (!out)
    return fmt::format("weft simulate with --out saves the last good state, of t = {:.6g} s", state->time_s);
  const std::filesystem::path file = last_good_file(*out);
  const bool full = simulation.plan().precision == "f64";
  try {
    write_csv(file, simulation.model(), *state, full ? Digits::full : Digits::single);
  } catch (const Error& failure) {
    return fmt::format("the last good state, of t = {:.6g} s, is not saved: {}", state->time_s,
                       failure.what());
  }
  return fmt::format("the last good state, of t = {:.6g} s, is in {}", state->time_s,
                     in_quotes(file.string(), 200));
}

}  // namespace

std::filesystem::path last_good_file(const std::filesystem::path& out) {
  std::filesystem::path file = out;
  return file.replace_extension(".last-good.csv");
}

void stop_if_diverged(Simulation& simulation, const std::optional<std::filesystem::path>& out) {
  const std::optional<Divergence> found = simulation.divergence();
  if (!found) return;
  throw divergence_error(*found, simulation.model(), simulation.plan(), save_last_good(simulation, out));
}

}  // namespace weft::cli
