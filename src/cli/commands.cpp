// The list of commands, in the order that people meet them.
#include <array>

#include "cli/command.h"

namespace weft::cli {

std::span<const Command* const> commands() {
  static constexpr std::array kCommands = {&view_command,      &render_command,   &simulate_command,
                                           &plan_command,      &validate_command, &study_command,
                                           &bench_command,     &devices_command,  &scenes_command,
                                           &materials_command, &solvers_command};
  return kCommands;
}

}  // namespace weft::cli
