// `weft study`: accuracy against time, measured for every solver, and written as a report.
#include "study/study.h"

#include <algorithm>

#include "cli/command.h"
#include "cli/interrupt.h"
#include "cli/setup.h"
#include "cli/study_watch.h"
#include "cli/table.h"
#include "study/kept_studies.h"
#include "study/report.h"

namespace weft::cli {
namespace {

constexpr double kTimeDefault_s = 0.5;
constexpr std::uint32_t kQuickResolutionMax = 33;  // unless --resolution or --resolutions says otherwise

/// @throws Error(Exit::usage) for options that the sweep itself sets
void refuse_contradictions(const Options& o) {
  if (o.substeps)
    throw Error(Exit::usage,
                "study: --substeps is given; it must not be, since a study sweeps the substeps itself");
  const auto refuse_both = [](bool one, bool many, const char* name) {
    if (one && many)
      throw error(Exit::usage, "study: --{0} and --{0}s are both given; give one of them", name);
  };
  refuse_both(o.resolution.has_value(), !o.study.resolutions.empty(), "resolution");
  refuse_both(o.solver.has_value(), !o.study.solvers.empty(), "solver");
  refuse_both(o.precision.has_value(), !o.study.precisions.empty(), "precision");
  if (o.time_s && *o.time_s <= 0.0)
    throw Error(Exit::usage, "study: --time is 0; it must be more, in s (for example --time 0.5)");
}

/// Scene keys without those that the sweep sets.
Options for_scene(Options o) {
  o.solver.reset();
  o.precision.reset();
  return o;
}

study::SweepOptions sweep_options(const Options& o, const Scene& scene) {
  study::SweepOptions sweep;
  sweep.time_s = o.time_s.value_or(kTimeDefault_s);
  sweep.quick = o.study.quick;
  sweep.resolutions = o.study.resolutions;
  if (sweep.resolutions.empty() && sweep.quick && !o.resolution)
    sweep.resolutions = {std::min(scene.cloth.resolution, kQuickResolutionMax)};
  sweep.solvers = o.study.solvers;
  if (o.solver) sweep.solvers = {*o.solver};
  for (const std::string& name : sweep.solvers) find_solver(name);
  sweep.precisions = o.study.precisions;
  if (o.precision) sweep.precisions = {*o.precision};
  sweep.command = o.command_line;
  return sweep;
}

/// --out as a folder that exists; its parent must.
std::filesystem::path make_out_folder(const Options& o) {
  if (!o.out)
    throw Error(Exit::usage, "study: --out is missing; it must name a folder (for example --out study-1)");
  std::error_code failure;
  std::filesystem::create_directory(*o.out, failure);
  if (!std::filesystem::is_directory(*o.out, failure))
    throw error(Exit::io,
                "--out {}: this is no folder and cannot be made one; the folder above it must exist",
                o.out->string());
  return *o.out;
}

Table table_of(const study::Study& study) {
  Table table{{"solver", "precision", "substeps", "resolution", "error_m", "ms_per_simulated_s", "ms_a_frame",
               "springs_a_frame", "max_stretch", "p99_stretch"},
              {}};
  for (const study::Point& p : study.points)
    table.rows.push_back(
        {p.setting.solver, p.setting.precision, p.setting.substeps, fmt::format("{}x{}", p.nx, p.ny),
         p.diverged ? nlohmann::ordered_json("diverged") : nlohmann::ordered_json(p.error_m), p.ms_per_s,
         study::ms_per_frame(p, study.frame_s), p.springs_per_frame, p.max_stretch, p.p99_stretch});
  return table;
}

void print(const Options& o, const study::Study& study, const study::ReportFiles& files) {
  if (o.format == Format::json) return print_result(study::to_json(study));
  std::string text = to_text(table_of(study), o.format);
  if (o.format == Format::human) {
    text = fmt::format("{} · {} · first {:g} s\n{}", study.title, study.device, study.time_s, text);
    for (const study::Omission& omission : study.left_out)
      text += fmt::format("left out: {}: {}\n", omission.what, omission.reason);
    for (const study::Omission& replaced : study.by_reference)
      text += fmt::format("run by the CPU reference: {}: {}\n", replaced.what, replaced.reason);
    for (const auto& file : files.written) text += fmt::format("wrote {}\n", file.string());
  }
  print_result(text);
}

Exit run_study(const Options& asked) {
  const Options o = with_default_device(asked);
  refuse_contradictions(o);
  refuse_vulkan_options(o, false);
  const std::string& name = only_scene(o);
  const Scene scene = open_scene(for_scene(o), name);
  study::SweepOptions sweep = sweep_options(o, scene);
  for (const std::uint32_t nx : sweep.resolutions) {
    Scene checked = scene;
    checked.cloth.resolution = nx;
    build_model(checked);
  }
  const std::filesystem::path folder = make_out_folder(o);
  sweep.records = folder / "points";
  std::unique_ptr<gpu::Device> device;
  if (o.on_vulkan()) device = open_device(o);
  const study::Bench bench = study_bench(o, device.get());
  stop_between_frames();
  StudyWatch watch(o, scene.title);
  study::Study study;
  try {
    study = study::run_study(bench, scene, sweep, watch.watch());
  } catch (const Error& failure) {
    if (failure.code() != Exit::interrupted) throw;
    throw error(Exit::interrupted,
                "interrupted; the points measured so far are kept in {}, and the same "
                "command goes on from there",
                sweep.records.string());
  }
  watch.finish();
  study::keep_study(scene, study);
  const study::ReportFiles files = study::write_report(folder, study);
  if (!files.png_missing.empty()) note(o, "no PNG pictures: " + files.png_missing + "; the SVG are the same");
  report_validation(device.get());
  print(o, study, files);
  return Exit::ok;
}

void add_sweep_options(CLI::App& app, Options& o) {
  add_scene(app, o);
  add_out(app, o, "the folder for the report; made when it is not there");
  add_study_options(app, o);
}

}  // namespace

const Command study_command{"study",
                            "measures what accuracy costs: every solver, substep count and precision",
                            "  weft study 1 --out study-1 --quick\n"
                            "  weft study 2 --out study-2 --time 0.5 --resolutions 20,40\n"
                            "  weft study 5 --out study-5 --solvers leapfrog,rk4 --device cpu",
                            add_sweep_options, run_study};

}  // namespace weft::cli
