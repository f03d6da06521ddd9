// Choosing reads the kept study, or makes and keeps one.
#include "cli/choose.h"

#include "cli/interrupt.h"
#include "cli/setup.h"
#include "cli/study_watch.h"
#include "core/error.h"
#include "study/choose.h"
#include "study/kept_studies.h"

namespace weft::cli {
namespace {

/// @throws Error(Exit::usage)
void refuse_contradictions(const Options& o, double time_s) {
  const char* wish = o.error_m ? "--error" : "--budget";
  if (o.error_m && o.budget_ms)
    throw Error(Exit::usage, "--error and --budget are both given; each chooses the setting, so give one");
  if (o.substeps || o.solver)
    throw error(Exit::usage, "{} and {} are both given; {} chooses solver and substeps itself, so give one",
                wish, o.substeps ? "--substeps" : "--solver", wish);
  if (time_s <= 0.0)
    throw error(Exit::usage,
                "{} with --time 0: nothing runs, so nothing can be measured; give a longer --time", wish);
}

std::string described(const study::Point& p, double frame_s) {
  return fmt::format(
      "{} {} at {} substeps a frame: error {:.2e} m, {:.3g} ms a frame, {:.4g} ms per simulated s",
      p.setting.solver, p.setting.precision, p.setting.substeps, p.error_m, study::ms_per_frame(p, frame_s),
      p.ms_per_s);
}

study::Study study_of(const Options& o, const Scene& scene, double time_s) {
  std::unique_ptr<gpu::Device> device;
  if (o.on_vulkan()) device = open_device(o);
  const study::Bench bench = study_bench(o, device.get());
  stop_between_frames();
  if (!study::kept_study(scene, bench.label, time_s))
    note(o,
         fmt::format("no study of this scene over {:g} s on {} is kept; measuring in quick form, which takes "
                     "up to two minutes",
                     time_s, bench.label));
  StudyWatch watch(o, scene.title);
  return study::study_for_choosing(bench, scene, time_s, watch.watch());
}

/// @throws Error(Exit::usage) when none does
study::Point choose(const Options& o, const study::Study& study, const std::vector<study::Point>& points) {
  const auto best = study::most_accurate(points), cheapest = study::cheapest(points);
  if (!best)
    throw error(Exit::usage, "{}: every setting of the study diverged on {}; nothing can be chosen",
                study.source, study.device);
  if (o.error_m) {
    if (const auto chosen = study::choose_for_error(points, *o.error_m)) return *chosen;
    throw error(
        Exit::usage,
        "--error is {:g}; no setting on {} has an error below that, in m; the most accurate is {} (ask for "
        "at least --error {:.1e})",
        *o.error_m, study.device, described(*best, study.frame_s), 1.1 * best->error_m);
  }
  if (const auto chosen = study::choose_for_budget(points, *o.budget_ms, study.frame_s)) return *chosen;
  const double needed_ms = study::ms_per_frame(*cheapest, study.frame_s);
  throw error(Exit::usage,
              "--budget is {:g}; on {} even the cheapest setting misses it by {:.3g} ms a frame: {} (allow "
              "--budget {:.3g}, or lower --resolution)",
              *o.budget_ms, study.device, needed_ms - *o.budget_ms, described(*cheapest, study.frame_s),
              1.1 * needed_ms);
}

}  // namespace

Options with_chosen_setting(const Options& asked, const std::string& scene_name,
                            const std::function<double(const Scene&)>& run_time_s) {
  if (!asked.error_m && !asked.budget_ms) return asked;
  const Options on_device = with_default_device(asked);  // what is measured is what will run
  Options quiet = on_device;
  quiet.quiet = true;  // the command itself says the scene's warnings
  quiet.precision.reset();
  const Scene scene = open_scene(quiet, scene_name);
  const double time_s = run_time_s(scene);
  refuse_contradictions(asked, time_s);
  const study::Study kept = study_of(on_device, scene, time_s);
  std::vector<study::Point> points;
  for (const study::Point& point : kept.promises_at(scene.cloth.resolution))
    if (!asked.precision || point.setting.precision == *asked.precision) points.push_back(point);
  const study::Point chosen = choose(asked, kept, points);
  note(asked, "chosen: " + described(chosen, kept.frame_s));
  Options options = on_device;
  options.solver = chosen.setting.solver;
  options.precision = chosen.setting.precision;
  options.substeps = chosen.setting.substeps;
  return options;
}

}  // namespace weft::cli
