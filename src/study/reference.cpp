// Refining a solver in double until it agrees with itself, twins and floors beside it, as many at a time as
// there are processors: a small cloth does not fill them alone.
#include "study/reference.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "model/measures.h"
#include "plan/plan.h"

namespace weft::study {
namespace {

using Clock = std::chrono::steady_clock;
using Note = std::function<void(const std::string&)>;

constexpr double kNoGain = 0.7;            // a level that halves the step but not the distance by this much
constexpr std::uint32_t kFirstLevels = 3;  // run side by side before anything is known

double seconds_since(Clock::time_point began) {
  return std::chrono::duration<double>(Clock::now() - began).count();
}

std::uint32_t automatic_substeps(const Model& model, const std::string& solver) {
  Model automatic = with_setting(model, {.solver = solver, .precision = "f64", .substeps = 0});
  return substeps_per_frame(automatic, find_solver(solver));
}

std::future<Trajectory> start_run(const Model& model, Setting setting, double time_s, const Stop& stop,
                                  std::optional<State> start = {}) {
  return std::async(std::launch::async, [&model, setting, time_s, &stop, start = std::move(start)] {
    return run_on_cpu(model, setting, time_s, stop, start);
  });
}

/// leapfrog in float at 2, 4 and 8 times its automatic substeps: the smaller of the two distances.
double float_floor_m(const Model& model, const std::string& fallback, double time_s, const Stop& stop) {
  const bool able = what_solver_lacks(model, find_solver("leapfrog")).empty();
  const std::string solver = able ? "leapfrog" : fallback;
  const std::uint32_t n = automatic_substeps(model, solver);
  Trajectory coarse = run_on_cpu(model, {solver, "f32", 2 * n}, time_s, stop);
  double least_m = std::numeric_limits<double>::infinity();
  for (const std::uint32_t factor : {4u, 8u}) {
    Trajectory fine = run_on_cpu(model, {solver, "f32", factor * n}, time_s, stop);
    least_m = std::min(least_m, trajectory_distance(coarse, fine));
    coarse = std::move(fine);
  }
  return least_m;
}

/// The levels of refinement, the newest two of them kept.
class Refinement {
 public:
  Refinement(const Model& model, double time_s, const ReferenceOptions& options, const Stop& stop)
      : model_(model),
        time_s_(time_s),
        options_(options),
        stop_(stop),
        solver_(reference_solver(model).name),
        substeps_(automatic_substeps(model, solver_)) {}

  const std::string& solver() const { return solver_; }
  Setting setting(std::uint32_t level) const { return {solver_, "f64", substeps_at(level)}; }

  std::uint32_t substeps_at(std::uint32_t level) const { return substeps_ << level; }
  const Trajectory& newest() const { return newest_; }
  Trajectory take() { return std::move(newest_); }

  /// Returns whether refinement is at its end; reference.ending then says why.
  bool add(Trajectory level, std::uint32_t number, Reference& reference) {
    const double before_m = reference.agreement_m;
    if (!all_finite(level.back()))
      throw error(Exit::diverged, "{}: the reference ({}, f64, {} substeps) left the finite numbers",
                  model_.scene.source, solver_, substeps_at(number));
    if (number > 0) reference.agreement_m = trajectory_distance(newest_, level);
    newest_ = std::move(level);
    reference.substeps = substeps_at(number);
    if (number == 0) return false;
    reference.ending = Ending::agreed;
    if (reference.agreement_m <= options_.tolerance_m && number + 1 >= options_.levels_min) return true;
    reference.ending = Ending::no_gain;
    return number > 1 && reference.agreement_m > kNoGain * before_m;
  }

  /// Levels beyond the first ones, one by one while there is time: each takes twice as long as the last.
  void refine_further(Clock::time_point began, double last_level_s, Reference& reference, const Note& note) {
    for (std::uint32_t number = kFirstLevels; number < options_.levels_max; ++number) {
      reference.ending = so_far(reference);
      if (seconds_since(began) + 2.0 * last_level_s > options_.seconds) return;
      if (substeps_at(number) > (1u << 22)) return;
      note(fmt::format("reference at {} substeps a frame (agreement so far {:.1e} m)", substeps_at(number),
                       reference.agreement_m));
      const auto level_began = Clock::now();
      Trajectory level = run_on_cpu(model_, setting(number), time_s_, stop_);
      last_level_s = seconds_since(level_began);
      if (add(std::move(level), number, reference)) return;
    }
    reference.ending = so_far(reference);
  }

 private:
  /// How refinement would be said to have ended if no level followed.
  Ending so_far(const Reference& reference) const {
    return reference.agreement_m <= options_.tolerance_m ? Ending::agreed : Ending::out_of_time;
  }
  const Model& model_;
  double time_s_;
  const ReferenceOptions& options_;
  const Stop& stop_;
  std::string solver_;
  std::uint32_t substeps_;
  Trajectory newest_;
};

/// The same cloth at 2·nx − 1 particles, which shares every particle's place; the same solver in double.
void measure_discretisation(const Model& model, double time_s, const Stop& stop, Reference& reference) {
  Scene scene = model.scene;
  scene.cloth.resolution = 2 * model.grid.nx - 1;
  scene.solver.substeps = 0;
  const Model fine = build_model(scene);
  const std::uint32_t n = automatic_substeps(fine, reference.solver);
  const Trajectory frames = run_on_cpu(fine, {reference.solver, "f64", n}, time_s, stop);
  reference.fine_nx = fine.grid.nx;
  reference.discretisation_m = 0.0;
  for (std::size_t f = 0; f < std::min(frames.size(), reference.frames.size()); ++f)
    reference.discretisation_m =
        std::max(reference.discretisation_m,
                 resolution_distance(model.grid, reference.frames[f], fine.grid, frames[f]));
}

/// Bytes of a trajectory.
double trajectory_bytes(const Model& model, double time_s) {
  return 2.0 * sizeof(glm::dvec3) * model.grid.count() * (time_s / model.scene.solver.frame_s + 2.0);
}

}  // namespace

const Solver& reference_solver(const Model& model) {
  const Solver& exact = find_solver("rk4");
  if (what_solver_lacks(model, exact).empty()) return exact;
  for (const Solver* solver : solvers())
    if (what_solver_lacks(model, *solver).empty()) return *solver;
  compile_plan(model, exact);  // says what no solver has
  return exact;
}

State perturbed_start(const Model& model, double distance_m) {
  State state = start_state(model);
  std::uint64_t sequence = 0x9e3779b97f4a7c15u;
  const auto next = [&sequence] {  // xorshift64: the same numbers everywhere
    sequence ^= sequence << 13, sequence ^= sequence >> 7, sequence ^= sequence << 17;
    return static_cast<double>(sequence >> 11) / 9007199254740992.0 - 0.5;
  };
  double sum = 0.0;
  std::vector<glm::dvec3> moves(state.position.size(), glm::dvec3(0.0));
  for (std::size_t p = 0; p < moves.size(); ++p) {
    if (model.relative_inverse_mass[p] == 0.0) continue;
    moves[p] = {next(), next(), next()};
    sum += glm::dot(moves[p], moves[p]);
  }
  if (sum == 0.0) return state;
  const double scale = distance_m / std::sqrt(sum / static_cast<double>(moves.size()));
  for (std::size_t p = 0; p < moves.size(); ++p) state.position[p] += scale * moves[p];
  return state;
}

Reference make_reference(const Model& model, double time_s, const ReferenceOptions& options, const Stop& stop,
                         const Note& note) {
  if (8.0 * trajectory_bytes(model, time_s) > static_cast<double>(options.memory_bytes))
    throw error(Exit::usage,
                "{}: a study of {:.6g} s at {}x{} particles holds {:.3g} GiB of reference states; at most "
                "{:.3g} GiB are allowed (shorten --time, or lower --resolution)",
                model.scene.source, time_s, model.grid.nx, model.grid.ny,
                8.0 * trajectory_bytes(model, time_s) / (1u << 30),
                static_cast<double>(options.memory_bytes) / (1u << 30));
  const auto began = Clock::now();
  Refinement refinement(model, time_s, options, stop);
  note(fmt::format("reference: {} in double at {}, {}, {} substeps a frame, and its twin",
                   refinement.solver(), refinement.substeps_at(0), refinement.substeps_at(1),
                   refinement.substeps_at(2)));
  std::vector<std::future<Trajectory>> levels;
  for (std::uint32_t number = kFirstLevels; number-- > 0;)
    levels.insert(levels.begin(), start_run(model, refinement.setting(number), time_s, stop));
  std::future<Trajectory> twin =
      start_run(model, refinement.setting(0), time_s, stop, perturbed_start(model, kTwinStart_m));
  std::future<double> float_floor =
      std::async(std::launch::async, [&] { return float_floor_m(model, refinement.solver(), time_s, stop); });
  Reference reference{.solver = refinement.solver(), .allowed_s = options.seconds};
  bool ended = false;
  for (std::uint32_t number = 0; number < kFirstLevels; ++number) {
    Trajectory level = levels[number].get();
    if (!ended) ended = refinement.add(std::move(level), number, reference);
    if (number == 0) reference.twin_m = trajectory_distance(refinement.newest(), twin.get());
  }
  reference.float_floor_m = float_floor.get();
  if (!ended) refinement.refine_further(began, seconds_since(began), reference, note);
  reference.frames = refinement.take();
  if (options.discretisation && seconds_since(began) < options.seconds) {
    note("the same cloth at twice the resolution");
    measure_discretisation(model, time_s, stop, reference);
  }
  return reference;
}

std::string_view name_of(Ending ending) {
  switch (ending) {
    case Ending::agreed: return "agreed";
    case Ending::no_gain: return "no gain";
    case Ending::out_of_time: return "out of time";
  }
  return "";
}

}  // namespace weft::study
