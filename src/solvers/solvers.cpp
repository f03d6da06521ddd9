// The list of solvers, finding one by name, and the automatic number of substeps.
#include <array>
#include <cmath>

#include "core/error.h"
#include "passes/collision.h"
#include "solvers/list.h"

namespace weft {
namespace {

constexpr std::array kSolvers{
    &leapfrog, &velocity_verlet, &symplectic_euler, &verlet, &euler, &trapezoid, &rk4, &xpbd};
constexpr double kSubstepsMax = 16777216.0;  // 2²⁴: a frame longer than that never ends
constexpr double kStepShare = 0.9;           // of the largest stable step

}  // namespace

std::span<const Solver* const> solvers() { return kSolvers; }

const Solver& find_solver(std::string_view name) {
  std::string valid;
  for (const Solver* solver : kSolvers) {
    if (solver->name == name) return *solver;
    valid += (valid.empty() ? "" : ", ") + std::string(solver->name);
  }
  throw error(Exit::usage, "solver.name is \"{}\"; it must be one of: {}", name, valid);
}

std::uint32_t substeps_per_frame(const Model& model, const Solver& solver) {
  const SolverSection& section = model.scene.solver;
  if (section.substeps > 0) return section.substeps;
  if (solver.substeps_default > 0) return solver.substeps_default;
  const double step_s = kStepShare * solver.step_max_s(model.bound);
  const double needed = std::ceil(section.frame_s / step_s);
  if (!(needed <= kSubstepsMax))
    throw error(
        Exit::usage,
        "{}: the largest stable step is {:.3g} s, so that a frame of {:.3g} s needs {:.3g} substeps; at "
        "most {:.0f} are possible (lower cloth.resolution, material.membrane or material.bend, or raise "
        "material.density)",
        place_of(model.scene, "cloth.resolution"), step_s / kStepShare, section.frame_s, needed,
        kSubstepsMax);
  return std::max(static_cast<std::uint32_t>(std::max(1.0, needed)), contact_substeps(model));
}

}  // namespace weft
