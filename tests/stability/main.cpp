// Writes docs/stability.md: every hard case with every solver on the CPU reference and on a device, and a
// picture of where the default solver left the cloth. Usage: weft_stability DOCS_FOLDER DATE
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <iostream>

#include "core/error.h"
#include "core/file.h"
#include "render/image.h"
#include "render/offscreen.h"
#include "sim/gpu_simulation.h"
#include "support/hard_cases.h"

namespace weft::hard {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHead = R"(# What the hard cases come to

`scripts/stability` writes this page: scenes made to break a simulation, with every solver of `weft solvers`,
on the CPU reference and on a device, at the automatic number of substeps. A solver added to the list appears
here by itself. tests/hard_cases holds the default solver, leapfrog, to its promises: every case finite,
nobody inside a single collider by more than 1 % of its radius, nobody through it, no energy out of nothing, a
free cloth's momentum at round-off.

*detected*: the run stopped at that frame, because the state was no longer sound
([physics.md](physics.md) "Divergence"); the columns then hold up to the frame before. *stretch*: most of a
structural spring at any frame's end. *energy*: most above the start's, over what was stored or could fall at
the start; only where nothing moves and no wind blows. *inside*: deepest in a sphere, of its radius, or below
the floor, of the cloth's width. *tunnelled*: particles that went through a collider from one frame's end to
the next. *time*: of the run, reading every frame back included, on a busy machine.

**The wedge.** Where two colliders overlap, or one and the floor, contact serves one after the other. A
particle may then be inside one by as much as the other pushes it back in; it is pushed out as soon as
one lets go, and stays finite meanwhile.

**Where no bound holds.** The largest stable step bounds every linear oscillation. Where springs are stretched
or pressed to several times their length, particles fly over a whole spring in one substep, and a cloth
without any damping can gain energy all the same: a ribbon of two columns, for which the bound is sharp,
started at 4.7 times its length, did at the automatic 68 substeps a frame and did not at 100. That is
detected, never hidden; damping or more substeps cure it.
)";

std::string percent(double share) {
  if (!std::isfinite(share)) return "-";
  return fmt::format("{:.3g} %", 100.0 * share);
}

std::string row(const HardCase& c, const Solver& solver, const std::string& device, const Outcome& o) {
  const std::string result =
      o.divergence ? fmt::format("detected, frame {}", o.divergence->frame) : std::string("finite");
  return fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {:.2g} s |\n", solver.name, device, result,
                     o.substeps, percent(o.max_stretch), c.closed ? percent(o.energy_gain) : "-",
                     percent(o.inside), o.tunnelled, o.wall_s);
}

class Page {
 public:
  explicit Page(fs::path folder) : folder_(std::move(folder)), device_({}) {
    pipelines_ = std::make_shared<GpuPipelines>(device_);
    fs::create_directories(folder_ / "stability");
  }
  std::string write(const std::string& date) {
    std::string text = kHead + fmt::format("\nDevice: {}. Measured {}.\n", device_.info().name, date);
    for (const HardCase& c : hard_cases()) text += section(c);
    return text;
  }

 private:
  std::string section(const HardCase& c) {
    std::cerr << c.name << std::flush;
    std::string text = fmt::format(
        "\n## {}\nA cloth {} `tests/hard_cases/{}.toml`{}, {:.3g} s.\n\n![{}](stability/{}.png)\n\n"
        "| solver | on | result | substeps | stretch | energy | inside | tunnelled | time |\n"
        "|---|---|---|---|---|---|---|---|---|\n",
        c.name, sentence(c), c.scene, settings(c), c.time_s, c.name, c.name);
    for (const Solver* solver : solvers()) {
      const Outcome on_cpu = run_hard_case(
          c, *solver, [](const Model& m, const Solver& s) { return make_cpu_simulation(m, s, "f32"); });
      text += row(c, *solver, "CPU", on_cpu);
      if (solver == solvers().front()) draw(c, on_cpu);
      if (solver->on_gpu)
        text += row(
            c, *solver, "device",
            run_hard_case(c, *solver, [&](const Model& m, const Solver& s) -> std::unique_ptr<Simulation> {
              return GpuSimulation::create(device_, m, s, {.pipelines = pipelines_});
            }));
      std::cerr << '.' << std::flush;
    }
    std::cerr << '\n';
    return text;
  }
  static std::string sentence(const HardCase& c) { return c.about + "."; }
  static std::string settings(const HardCase& c) {
    std::string text;
    for (const std::string& set : c.set) text += fmt::format("{}`{}`", text.empty() ? " with " : ", ", set);
    return text;
  }
  void draw(const HardCase& c, const Outcome& outcome) {
    const Model model = hard_model(c);
    Camera camera;
    glm::dvec3 low = outcome.end.position[0], high = low;
    for (const glm::dvec3& x : outcome.end.position) {
      low = glm::min(low, x);
      high = glm::max(high, x);
    }
    camera.target_m = 0.5 * (low + high);
    camera.distance_m = std::max(0.5, 1.4 * glm::length(high - low));
    camera.yaw_rad = 0.5;
    camera.pitch_rad = 0.25;
    OffscreenRenderer renderer(device_, model, {.width = 200, .height = 150, .samples = 4, .camera = camera});
    write_png(folder_ / "stability" / (c.name + ".png"), renderer.draw(outcome.end));
  }

  fs::path folder_;
  gpu::Device device_;
  std::shared_ptr<GpuPipelines> pipelines_;
};

}  // namespace
}  // namespace weft::hard

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: weft_stability DOCS_FOLDER DATE\n";
    return 2;
  }
  try {
    weft::hard::Page page(argv[1]);
    weft::write_file(std::filesystem::path(argv[1]) / "stability.md", page.write(argv[2]));
  } catch (const weft::Error& failure) {
    std::cerr << failure.what() << '\n';
    return static_cast<int>(failure.code());
  }
  return 0;
}
