// The sweep: which settings, in which order, and one record a finished point, so that an interrupted study
// goes on where it was.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include "core/error.h"
#include "core/file.h"
#include "plan/plan.h"
#include "sim/native_simulation.h"
#include "study/equilibrium.h"
#include "study/identity.h"
#include "study/study.h"

namespace weft::study {
namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

// Shares of the automatic count, the most telling first: a quick study takes the front of the list, and what
// the time does not allow for is lost from its end.
constexpr double kBounded[] = {1.0, 2.0, 0.5, 4.0, 8.0, 0.70710678, 1.41421356, 2.82842712};
constexpr double kUnbounded[] = {1.0, 5.0, 0.25, 2.5, 10.0, 0.5};
constexpr std::size_t kQuickBounded = 4, kQuickUnbounded = 3;

constexpr double kQuickSeconds = 105.0;  // of the two minutes that --quick promises
constexpr double kNoLimit_s = 1e8;
constexpr double kQuickReferenceSeconds = 25.0;

// The reference's own solver in double is swept up to 4 (quick) or 8 times its automatic count. Two
// refinements beyond, rk4 agrees with itself to a sixteenth of the error there, and what is of second order
// to a quarter.
constexpr std::uint32_t kLevelsBesideQuick = 5, kLevelsBeside = 6;

/// One resolution's part of the sweep.
struct Part {
  Model model;
  Reference reference;
  Equilibrium equilibrium;
};

struct Task {
  std::size_t part = 0;
  Setting setting;
};

/// Points on disk, one file each.
class Records {
 public:
  Records(const SweepOptions& options, const Bench& bench) : options_(options), device_(bench.label) {
    if (!options.records.empty() && !make_folder(options.records))
      throw error(Exit::io, "{}: this folder for the study's records cannot be made",
                  options.records.string());
  }

  std::optional<Point> load(const Model& model, const Setting& setting) const {
    if (options_.records.empty()) return {};
    const std::string identity = identity_of(model, setting);
    std::error_code failure;
    const auto file = file_of(identity);
    if (!std::filesystem::is_regular_file(file, failure)) return {};
    try {
      const Json json = Json::parse(read_file(file));
      if (json.at("identity") != identity) return {};
      return point_from_json(json.at("point"));
    } catch (const std::exception&) {  // damaged: measured anew and written over
      return {};
    }
  }

  void keep(const Model& model, const Point& point) const {
    if (options_.records.empty()) return;
    const std::string identity = identity_of(model, point.setting);
    write_file(file_of(identity), Json{{"identity", identity}, {"point", to_json(point)}}.dump(2) + '\n');
  }

 private:
  std::string identity_of(const Model& model, const Setting& s) const {
    return fmt::format("point {}\ndevice={}\ntime={:.17g}\nquick={}\n{} {} {}\n{}", kFormatVersion, device_,
                       options_.time_s, options_.quick, s.solver, s.precision, s.substeps,
                       canonical_scene(model.scene));
  }
  std::filesystem::path file_of(const std::string& identity) const {
    return options_.records / (name_of(identity) + ".json");
  }
  const SweepOptions& options_;
  std::string device_;
};

bool wanted(const std::vector<std::string>& list, std::string_view name) {
  return list.empty() || std::find(list.begin(), list.end(), name) != list.end();
}

Cloth describe(const Part& part) {
  const Reference& r = part.reference;
  return {.nx = part.model.grid.nx,
          .ny = part.model.grid.ny,
          .reference_solver = r.solver,
          .reference_substeps = r.substeps,
          .agreement_m = r.agreement_m,
          .ending = std::string(name_of(r.ending)),
          .twin_m = r.twin_m,
          .float_floor_m = r.float_floor_m,
          .discretisation_m = r.discretisation_m,
          .fine_nx = r.fine_nx,
          .equilibrium = part.equilibrium.found() ? "found" : part.equilibrium.reason};
}

class Sweep {
 public:
  Sweep(const Bench& bench, const Scene& scene, const SweepOptions& options, const Watch& watch)
      : bench_(bench),
        options_(options),
        watch_(watch),
        records_(options, bench),
        seconds_(options.quick ? std::min(options.seconds, kQuickSeconds) : options.seconds) {
    study_.title = scene.title;
    study_.source = std::filesystem::path(scene.source).filename().string();
    study_.device = bench.label;
    study_.command = options.command;
    study_.time_s = options.time_s;
    study_.frame_s = scene.solver.frame_s;
    study_.quick = options.quick;
    const std::vector<std::uint32_t> own{scene.cloth.resolution};
    for (const std::uint32_t nx : options.resolutions.empty() ? own : options.resolutions)
      add_part(scene, nx);
  }

  Study run() {
    const std::vector<Task> tasks = list_tasks();
    if (watch_.progress) watch_.progress(0, tasks.size());
    std::size_t done = 0;
    for (const Task& task : tasks) {
      run_task(task);
      if (watch_.progress) watch_.progress(++done, tasks.size());
    }
    study_.complete = options_.solvers.empty() && options_.precisions.empty();
    if (skipped_ > 0)
      study_.left_out.push_back(
          {fmt::format("{} of {} settings", skipped_, tasks.size()),
           fmt::format("{:.0f} s did not suffice; the same command again goes on, a study "
                       "without --quick takes its time",
                       seconds_)});
    study_.date = date_now();
    return std::move(study_);
  }

 private:
  double elapsed_s() const { return std::chrono::duration<double>(Clock::now() - began_).count(); }

  void add_part(Scene scene, std::uint32_t nx) {
    scene.cloth.resolution = nx;
    scene.solver.substeps = 0;
    Part part{.model = build_model(scene), .reference = {}, .equilibrium = {}};
    ReferenceOptions wish;
    if (options_.quick) wish.seconds = kQuickReferenceSeconds;
    const Solver& solver = reference_solver(part.model);
    if (wanted(options_.solvers, solver.name) && wanted(options_.precisions, "f64") &&
        unavailable(bench_, part.model, solver, "f64").empty())
      wish.levels_min = options_.quick ? kLevelsBesideQuick : kLevelsBeside;
    part.reference = find_reference(part.model, options_.time_s, wish, watch_.stop, watch_.note);
    watch_.note("static equilibrium");
    part.equilibrium = find_equilibrium(part.model, part.reference.frames.back(), watch_.stop);
    study_.cloths.push_back(describe(part));
    parts_.push_back(std::move(part));
  }

  /// In rounds: every solver at its most telling count, then every solver at its next.
  std::vector<Task> list_tasks() {
    std::map<std::size_t, std::vector<Task>> rounds;
    for (const std::string_view precision : precisions()) {
      if (!wanted(options_.precisions, precision)) continue;
      for (const Solver* solver : solvers()) {
        if (!wanted(options_.solvers, solver->name)) continue;
        if (const std::string reason = unavailable(bench_, parts_.front().model, *solver, precision);
            !reason.empty()) {
          study_.left_out.push_back({fmt::format("{} {}", solver->name, precision), reason});
          continue;
        }
        if (bench_.native) note_reference(*solver, std::string(precision));
        for (std::size_t part = 0; part < parts_.size(); ++part) {
          std::size_t round = 0;
          for (const std::uint32_t n : substep_counts(parts_[part].model, *solver, options_.quick))
            rounds[round++].push_back({part, {std::string(solver->name), std::string(precision), n}});
        }
      }
    }
    std::vector<Task> tasks;
    for (const auto& [round, list] : rounds) tasks.insert(tasks.end(), list.begin(), list.end());
    return tasks;
  }

  /// What native lacks runs on the reference: another machine's times, which the report must say.
  void note_reference(const Solver& solver, const std::string& precision) {
    const std::string reason = native_lacks(parts_.front().model, solver, precision);
    if (reason.empty()) return;
    const std::string what = fmt::format("{} {}", solver.name, precision);
    auto alike = std::ranges::find(study_.by_reference, reason, &Omission::reason);
    if (alike == study_.by_reference.end())
      study_.by_reference.push_back({what, reason});
    else
      alike->what += ", " + what;
  }

  std::uint64_t dispatches(const Part& part, const Setting& setting) const {
    return compile_plan(with_setting(part.model, setting), find_solver(setting.solver), setting.precision)
        .dispatches();
  }

  /// Seconds that a setting will take: two runs and a warm-up, from a point of the same solver; before there
  /// is one, from the dearest dispatch of the others, so that even a first point is not begun in vain.
  double expected_s(const Task& task) const {
    const Part& part = parts_[task.part];
    double dearest_ms = 0.0;  // a dispatch, per simulated second
    for (const Point& known : study_.points) {
      if (known.nx != part.model.grid.nx) continue;
      const bool alike =
          known.setting.solver == task.setting.solver && known.setting.precision == task.setting.precision;
      if (alike)
        return 2.2e-3 * known.ms_per_s * options_.time_s * task.setting.substeps / known.setting.substeps;
      dearest_ms =
          std::max(dearest_ms, known.ms_per_s / static_cast<double>(dispatches(part, known.setting)));
    }
    if (dearest_ms == 0.0) return 0.0;
    return 2.2e-3 * dearest_ms * options_.time_s * static_cast<double>(dispatches(part, task.setting));
  }

  void run_task(const Task& task) {
    const Part& part = parts_[task.part];
    if (auto kept = records_.load(part.model, task.setting)) {
      study_.points.push_back(std::move(*kept));
      return;
    }
    if (elapsed_s() > seconds_ || (seconds_ < kNoLimit_s && elapsed_s() + expected_s(task) > seconds_)) {
      ++skipped_;
      return;
    }
    watch_.note(fmt::format("{} {} at {} substeps, {} x {}", task.setting.solver, task.setting.precision,
                            task.setting.substeps, part.model.grid.nx, part.model.grid.ny));
    MeasureOptions how;
    if (options_.quick) how = {.run_count_max = 3, .timing_s = 0.5, .energy_drift = false};
    const Point point = measure(bench_, part.model, task.setting, part.reference, part.equilibrium.position,
                                how, watch_.stop);
    records_.keep(part.model, point);
    study_.points.push_back(point);
  }

  const Bench& bench_;
  const SweepOptions& options_;
  const Watch& watch_;
  Records records_;
  double seconds_;
  Clock::time_point began_ = Clock::now();
  std::vector<Part> parts_;
  std::size_t skipped_ = 0;
  Study study_;
};

}  // namespace

std::vector<std::uint32_t> substep_counts(const Model& model, const Solver& solver, bool quick) {
  const bool bounded = std::isfinite(solver.step_max_s(model.bound));
  Model automatic = model;
  automatic.scene.solver.substeps = 0;
  const double n = substeps_per_frame(automatic, solver);
  std::span<const double> shares = bounded ? std::span<const double>(kBounded) : kUnbounded;
  if (quick) shares = shares.first(bounded ? kQuickBounded : kQuickUnbounded);
  std::vector<std::uint32_t> counts;
  for (const double share : shares) {
    const auto count = static_cast<std::uint32_t>(std::max(1.0, std::round(share * n)));
    if (std::find(counts.begin(), counts.end(), count) == counts.end()) counts.push_back(count);
  }
  return counts;
}

Study run_study(const Bench& bench, const Scene& scene, const SweepOptions& options, const Watch& watch) {
  return Sweep(bench, scene, options, watch).run();
}

}  // namespace weft::study
