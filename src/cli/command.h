// The commands of `weft`: each is one file that fills one Command. Explicit list, no self-registration.
#pragma once
#include <CLI/CLI.hpp>
#include <span>
#include <string_view>

#include "cli/options.h"
#include "core/error.h"

namespace weft::cli {

struct Command {
  std::string_view name;
  std::string_view about;
  std::string_view examples;  ///< lines that work as they stand, shown by --help
  void (*add_options)(CLI::App&, Options&);
  /// Prints its result on stdout; returns the exit code.
  /// @throws Error for everything that fails; main prints it once
  Exit (*run)(const Options&);
  bool opens_device = true;  ///< --device by itself; else main sees to it that there is such a device
};

extern const Command bench_command;
extern const Command devices_command;
extern const Command materials_command;
extern const Command plan_command;
extern const Command render_command;
extern const Command scenes_command;
extern const Command simulate_command;
extern const Command solvers_command;
extern const Command study_command;
extern const Command validate_command;
extern const Command view_command;

/// All of them, in the order that `weft --help` lists them.
std::span<const Command* const> commands();

}  // namespace weft::cli
