// `weft render`: simulates a scene and draws it without a window, into a picture, a sequence or a film.
#include <algorithm>
#include <chrono>
#include <cmath>

#include "cli/choose.h"
#include "cli/command.h"
#include "cli/divergence.h"
#include "cli/interrupt.h"
#include "cli/progress.h"
#include "cli/setup.h"
#include "cli/state_output.h"
#include "cli/summary.h"
#include "render/offscreen.h"
#include "render/output.h"

namespace weft::cli {
namespace {

/// Pictures a simulated second.
/// @throws Error(Exit::usage) when there are fewer frames than pictures
double picture_rate(const Options& o, double frame_s) {
  const double most = 1.0 / frame_s;
  if (!o.picture.fps) return std::min(60.0, most);
  if (*o.picture.fps > most * (1.0 + 1e-6))
    throw error(
        Exit::usage,
        "--fps is {}; it must be at most {:.6g}, one picture a frame of {:.6g} s (or make frames shorter: "
        "--frame {:.6g})",
        *o.picture.fps, most, frame_s, 1.0 / *o.picture.fps);
  return *o.picture.fps;
}

RenderOptions render_options(const PictureOptions& picture, double run_s) {
  RenderOptions options;
  options.width = picture.width;
  options.height = picture.height;
  options.samples = picture.samples.value_or(0);
  options.film_s = run_s;
  options.look.shading = picture.flat ? Shading::flat : Shading::smooth;
  options.look.wireframe = picture.wireframe;
  return options;
}

/// The film in the making: draws the frames that are due.
class Film {
 public:
  Film(const Options& o, const Setup& setup, double run_s)
      : name_(o.out->string()),
        frame_s_(setup.scene().solver.frame_s),
        rate_(picture_rate(o, frame_s_)),
        only_last_(output_kind(name_) == OutputKind::picture),
        due_s_(only_last_ ? run_s : 0.0) {
    if (output_kind(name_) != OutputKind::sequence) require_writable(name_);
    output_ = open_output(name_, o.picture.width, o.picture.height, rate_);
  }

  /// Draws a picture once the simulated time reaches the next one's.
  void see(OffscreenRenderer& renderer, const Machine& machine) {
    const double time_s = machine.simulation->time_s();
    if (time_s < due_s_ - 1e-6 * frame_s_) return;
    output_->add(machine.drawn != nullptr ? renderer.draw(machine.drawn->draw_buffers(), time_s)
                                          : renderer.draw(machine.simulation->read()));
    ++pictures_;
    due_s_ = static_cast<double>(pictures_) / rate_;
  }

  void finish() { output_->finish(); }
  std::uint64_t pictures() const { return pictures_; }

 private:
  std::string name_;
  double frame_s_, rate_;
  bool only_last_;
  double due_s_;  ///< when the next picture is
  std::uint64_t pictures_ = 0;
  std::unique_ptr<PictureOutput> output_;
};

/// A simulation on the CPU is drawn by the best Vulkan device there is.
std::unique_ptr<gpu::Device> drawing_device(const Options& o) {
  Options drawing = o;
  drawing.device.clear();
  try {
    return open_device(drawing);
  } catch (const Error& failure) {
    if (failure.code() != Exit::no_device) throw;
    throw Error(Exit::no_device,
                "render: the CPU computes, but pictures are drawn by a Vulkan device and there is none "
                "that can be used; install a driver (Debian: mesa-vulkan-drivers), or use weft simulate");
  }
}

Outcome film_scene(const Options& o, const Machine& machine, OffscreenRenderer& renderer, double run_s,
                   Film& film) {
  Simulation& simulation = *machine.simulation;
  const Scene& scene = simulation.model().scene;
  Outcome outcome;
  Progress progress(scene.title.empty() ? "rendering" : scene.title, o.quiet);
  const auto look = [&](bool last) {
    if (last) outcome.state = simulation.read();
    stop_if_diverged(simulation, std::nullopt);
    film.see(renderer, machine);
  };
  const auto began = std::chrono::steady_clock::now();
  look(true);  // all there is of a run without frames
  run_for(simulation, run_s, [&](std::uint64_t done, std::uint64_t total, const FrameStats& stats) {
    outcome.spring_evaluations += stats.spring_evaluations;
    look(done == total || interrupted());
    progress.show(done, total);
    return !interrupted();
  });
  outcome.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  if (interrupted())
    throw error(Exit::interrupted, "interrupted at t = {:.6g} s; {} is not complete", simulation.time_s(),
                o.out->string());
  return outcome;
}

Exit run_render(const Options& asked) {
  const std::string& name = only_scene(asked);
  if (!asked.out)
    throw Error(Exit::usage,
                "render: --out is missing; it must name a .png, a .mp4 or DIR/frame-%04d.png "
                "(for example --out drop.mp4)");
  const Options o = with_chosen_setting(asked, name, [&](const Scene&) { return asked.time_or_default_s(); });
  refuse_vulkan_options(o, true);
  const Setup setup = set_up(o, name);
  const double run_s = o.time_or_default_s();
  stop_between_frames();
  Film film(o, setup, run_s);
  Machine machine = start(o, setup, run_s);
  if (!machine.device) draw_with(drawing_device(o), machine);
  Outcome outcome;
  {
    OffscreenRenderer renderer(*machine.device, setup.model, render_options(o.picture, run_s));
    outcome = film_scene(o, machine, renderer, run_s, film);
  }
  film.finish();
  report_validation(machine.device.get());
  nlohmann::ordered_json fields = summarize(setup, machine, outcome);
  const std::string drawn_by = device_label(machine.device->info());
  fields["drawn_by"] = drawn_by;
  fields["pictures"] = film.pictures();
  fields["out"] = o.out->string();
  print_summary(o, setup.scene(), fields,
                fmt::format("{} · {} {} · {}", machine.on_gpu ? "" : " · drawn by " + drawn_by,
                            film.pictures(), film.pictures() == 1 ? "picture" : "pictures", o.out->string()));
  return Exit::ok;
}

void add_render_options(CLI::App& app, Options& o) {
  add_scene(app, o);
  add_choice_options(app, o);
  add_out(app, o, "FILE.mp4, FILE.png (the end), or DIR/frame-%04d.png (every picture; makes its folder)");
  add_picture_options(app, o);
}

}  // namespace

const Command render_command{"render", "draws a scene into a picture or a film",
                             "  weft render 1 --time 2 --out hung.png\n"
                             "  weft render 5 --out drop.mp4 --size 960x540 --fps 30\n"
                             "  weft render 4 --time 1 --out frames/frame-%04d.png --wireframe",
                             add_render_options, run_render};

}  // namespace weft::cli
