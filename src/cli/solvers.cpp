// `weft solvers`: every solver with its order, where it runs, and its source.
#include "cli/command.h"
#include "cli/table.h"
#include "solvers/solver.h"

namespace weft::cli {
namespace {

Exit run_solvers(const Options& o) {
  Table table{{"name", "order", "on_gpu", "forces_per_substep", "about", "source"}, {}};
  for (const Solver* solver : weft::solvers())
    table.rows.push_back({std::string(solver->name), solver->order, solver->on_gpu,
                          solver->force_evaluations_per_substep, std::string(solver->about),
                          std::string(solver->source)});
  print_result(to_text(table, o.format));
  return Exit::ok;
}

}  // namespace

const Command solvers_command{"solvers",
                              "lists the solvers",
                              "  weft solvers\n  weft simulate 1 --device cpu --solver leapfrog --time 0.5",
                              [](CLI::App&, Options&) {},
                              run_solvers,
                              false};

}  // namespace weft::cli
