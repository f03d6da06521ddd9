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
};

extern const Command bench;
extern const Command devices;
extern const Command materials;
extern const Command plan;
extern const Command render;
extern const Command scenes;
extern const Command simulate;
extern const Command solvers;
extern const Command study;
extern const Command validate;
extern const Command view;

/// All of them, in the order that `weft --help` lists them.
std::span<const Command* const> commands();

}  // namespace weft::cli
