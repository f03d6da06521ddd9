// The list of commands, in the order that people meet them.
#include <array>

#include "cli/command.h"

namespace weft::cli {

std::span<const Command* const> commands() {
  static constexpr std::array kCommands = {&view,  &render,  &simulate, &plan,      &validate, &study,
                                           &bench, &devices, &scenes,   &materials, &solvers};
  return kCommands;
}

}  // namespace weft::cli
