// `weft simulate`: runs a scene headless, sums it up in one line, writes its state, checks its [expect]
// block.
#include <chrono>
#include <iostream>

#include "cli/choose.h"
#include "cli/command.h"
#include "cli/divergence.h"
#include "cli/interrupt.h"
#include "cli/progress.h"
#include "cli/setup.h"
#include "cli/state_output.h"
#include "cli/summary.h"
#include "cli/table.h"
#include "core/text.h"
#include "sim/expect.h"

namespace weft::cli {
namespace {

/// --time, else with --check the time at which the scene's checks are made, else 5 s.
double run_time_s(const Options& o, const Scene& scene) {
  if (!o.check) return o.time_or_default_s();
  if (!scene.expect)
    throw error(Exit::usage,
                "{}: --check needs an [expect] block and the scene has none; add one "
                "(for example max_stretch = 0.1)",
                scene.source);
  const double check_s = expect_time_s(scene, o.time_or_default_s());
  const double run_s = o.time_s.value_or(check_s);
  if (run_s < check_s)
    throw error(Exit::usage,
                "{}: expect.at_time is {} s and --time is {} s; the run must reach the check "
                "(leave --time away)",
                place_of(scene, "expect.at_time"), check_s, run_s);
  return run_s;
}

/// Called after every frame: asks whether the run has diverged, reads the state where somebody wants it,
/// feeds the writer, makes the scene's checks when due.
class FrameWatch {
 public:
  FrameWatch(const Options& o, const Setup& setup, double run_s, StateOutput* output)
      : check_(o.check),
        model_(setup.model),
        output_(output),
        out_(o.out),
        check_s_(expect_time_s(setup.scene(), run_s) - 1e-6 * setup.scene().solver.frame_s) {}

  void see(Simulation& simulation, bool last, Outcome& outcome) {
    stop_if_diverged(simulation, out_);
    const bool check_due = check_ && !checked_ && simulation.time_s() >= check_s_;
    const bool every = output_ != nullptr && output_->takes_every_frame();
    if (!every && !last && !check_due) return;
    State state = simulation.read();
    stop_if_diverged(simulation, out_);  // by now the device has judged this very state
    if (output_ != nullptr) output_->frame(state);
    if (check_due) {
      outcome.verdicts = check_expectations(model_, state);
      checked_ = true;
    }
    outcome.state = std::move(state);
  }

 private:
  bool check_, checked_ = false;
  const Model& model_;
  StateOutput* output_;
  std::optional<std::filesystem::path> out_;
  double check_s_;
};

Outcome simulate_scene(const Options& o, Simulation& simulation, double run_s, FrameWatch& watch) {
  Outcome outcome;
  const std::string& title = simulation.model().scene.title;
  Progress progress(title.empty() ? "simulating" : title, o.quiet);
  watch.see(simulation, true, outcome);  // all there is of a run without frames
  const auto began = std::chrono::steady_clock::now();
  run_for(simulation, run_s, [&](std::uint64_t done, std::uint64_t total, const FrameStats& stats) {
    if (done == 1) outcome.frame = stats;
    outcome.spring_evaluations += stats.spring_evaluations;
    watch.see(simulation, done == total || interrupted(), outcome);
    progress.show(done, total);
    return !interrupted();
  });
  outcome.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  if (interrupted())
    throw error(Exit::interrupted, "interrupted at t = {:.6g} s; nothing was written", simulation.time_s());
  return outcome;
}

/// What was recorded and allocated, beside what the plan, run by its kernel, says of a full frame.
void print_details(const Machine& machine, const Outcome& outcome) {
  const Plan& plan = machine.simulation->plan();
  const GpuSimulation* device = machine.on_gpu;
  const std::uint64_t dispatches =
      device != nullptr ? device->dispatches_expected(plan.substeps) : plan.dispatches();
  const std::uint64_t bytes = device != nullptr ? device->bytes_expected() : plan.bytes();
  std::cerr << fmt::format(
                   "weft: dispatches recorded {} in a frame of {} substeps; plan: {} in a frame of {}\n",
                   outcome.frame.dispatches, outcome.frame.substeps, dispatches, plan.substeps)
            << fmt::format("weft: bytes allocated {}; plan: {}\n", machine.simulation->bytes_allocated(),
                           bytes);
  if (device == nullptr) return;
  std::cerr << fmt::format(
      "weft: kernel {}; with one dispatch a substep and no scratch it would be {} dispatches and {} bytes\n",
      describe(device->kernel()), plan.dispatches(), plan.bytes());
}

/// Says what self-collision did; false when pairs found no room in its lists.
bool report_self_collision(const Options& o, Simulation& simulation) {
  const std::optional<SelfCollisionReport> report = simulation.self_collision();
  if (!report) return true;
  if (o.verbose)
    std::cerr << fmt::format(
        "weft: self-collision made its lists {}; the cloth stayed spread out, so that nothing could be near, "
        "in "
        "{}; the smallest gap of the last frame is {}\n",
        counted(report->lists_built, "time"), counted(report->spread_frames, "frame"),
        report->smallest_gap_m ? fmt::format("{:.3g} m", *report->smallest_gap_m)
                               : std::string("beyond the lists' reach"));
  if (report->held_back > 0)
    std::cerr << fmt::format(
        "weft: self-collision held a particle's motion back {}, so that no layers pass through each other: "
        "there the cloth was too fast or too crowded for its thickness (more substeps, or a greater "
        "self_collision.thickness, follow it better)\n",
        counted(report->held_back, "time"));
  if (report->pairs_dropped == 0) return true;
  std::cerr << fmt::format(
      "weft: self-collision: {} pairs found no room in the lists, so that contacts may have been missed: the "
      "cloth is crowded beyond what its thickness allows (raise cloth.resolution, or look for what crushes "
      "it)\n",
      report->pairs_dropped);
  return false;
}

Exit run_simulate(const Options& asked) {
  const std::string& name = only_scene(asked);
  const Options o =
      with_chosen_setting(asked, name, [&](const Scene& scene) { return run_time_s(asked, scene); });
  refuse_vulkan_options(o, false);
  const Setup setup = set_up(o, name);
  const double run_s = run_time_s(o, setup.scene());
  std::unique_ptr<StateOutput> output;
  stop_between_frames();
  if (o.out) output = std::make_unique<StateOutput>(*o.out, setup.model);
  Machine machine = start(o, setup, run_s);
  FrameWatch watch(o, setup, run_s, output.get());
  const Outcome outcome = simulate_scene(o, *machine.simulation, run_s, watch);
  report_validation(machine.device.get());
  if (output) output->finish(outcome.state);
  print_summary(o, setup.scene(), summarize(setup, machine, outcome));
  if (o.verbose) print_details(machine, outcome);
  const bool vouched = report_self_collision(o, *machine.simulation);
  if (!o.check) return vouched ? Exit::ok : Exit::tolerance;
  const std::string verdicts = describe(outcome.verdicts);
  if (o.format == Format::human)
    print_result(verdicts);
  else
    std::cerr << verdicts;
  return vouched && all_hold(outcome.verdicts) ? Exit::ok : Exit::tolerance;
}

void add_simulate_options(CLI::App& app, Options& o) {
  add_scene(app, o);
  add_choice_options(app, o);
  add_out(app, o, "write the final state: .csv, .ply or .obj; .pc2 holds every frame");
  app.add_flag("--check", o.check,
               "hold the scene's [expect] block against the result; exit 5 when it is broken");
}

}  // namespace

const Command simulate_command{"simulate", "runs a scene without pictures and sums it up",
                               "  weft simulate 1 --time 2\n"
                               "  weft simulate 4 --device cpu --precision f64 --time 0.5 --out state.csv\n"
                               "  weft simulate 1 --set wind.velocity=[0,0,5] --time 1 --format json\n"
                               "  weft simulate 2 --check",
                               add_simulate_options, run_simulate};

}  // namespace weft::cli
