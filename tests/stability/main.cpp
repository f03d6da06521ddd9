// Writes docs/stability.md: every hard case with every solver on the CPU reference, natively and on a device,
// and a sheet of pictures of where the default solver left the cloth. What a finished case came to is kept in
// PARTS_FOLDER, so that an interrupted run goes on. Usage: weft_stability DOCS_FOLDER PARTS_FOLDER DATE
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <iostream>

#include "core/error.h"
#include "core/file.h"
#include "render/image.h"
#include "render/offscreen.h"
#include "sim/gpu_simulation.h"
#include "sim/native_simulation.h"
#include "stability/crush_table.h"
#include "stability/head.h"
#include "support/hard_cases.h"

namespace weft::hard {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kTileWidth = 160, kTileHeight = 120, kColumns = 6;

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

/// Looks at the whole cloth from in front and a little above.
Camera camera_for(const State& state) {
  Camera camera;
  glm::dvec3 low = state.position[0], high = low;
  for (const glm::dvec3& x : state.position) {
    low = glm::min(low, x);
    high = glm::max(high, x);
  }
  camera.target_m = 0.5 * (low + high);
  camera.distance_m = std::max(0.5, 1.4 * glm::length(high - low));
  camera.yaw_rad = 0.5;
  camera.pitch_rad = 0.25;
  return camera;
}

class Page {
 public:
  Page(fs::path docs, fs::path parts) : docs_(std::move(docs)), parts_(std::move(parts)), device_({}) {
    pipelines_ = std::make_shared<GpuPipelines>(device_);
    fs::create_directories(parts_);
    fs::create_directories(docs_ / "images");
  }
  void write(const std::string& date) {
    std::string text =
        kHead +
        fmt::format(
            "\nDevice: {}; native: the CPU's vector units. Measured {} with `scripts/stability`.\n"
            "\n![Where leapfrog left the cloths](images/stability.png)\n\n*Where leapfrog left the "
            "cloths, alike on all three: the cases in the order of this page, {} a row. What stays a point "
            "or a line, and ribbons a millimetre wide, are too thin to be seen.*\n",
            device_.info().name, date, kColumns);
    const auto cases = hard_cases();
    const auto rows = static_cast<std::uint32_t>((cases.size() + kColumns - 1) / kColumns);
    Picture sheet{kColumns * kTileWidth, rows * kTileHeight, {}};
    sheet.rgba.assign(std::size_t{sheet.width} * sheet.height * 4, 255);
    for (std::size_t k = 0; k < cases.size(); ++k) {
      text += kept_section(cases[k]);
      place(read_png(picture_of(cases[k])), static_cast<std::uint32_t>(k), sheet);
    }
    write_png(docs_ / "images" / "stability.png", sheet);
    write_file(docs_ / "stability.md", text + crush_section());
  }

 private:
  fs::path picture_of(const HardCase& c) const { return parts_ / (c.name + ".png"); }

  /// The case's tables, from an earlier run where that got so far.
  std::string kept_section(const HardCase& c) {
    const fs::path kept = parts_ / (c.name + ".md");
    std::cerr << c.name << std::flush;
    if (fs::exists(kept) && fs::exists(picture_of(c))) {
      std::cerr << ": kept\n";
      return read_file(kept);
    }
    const std::string text = section(c);
    write_file(kept, text);
    std::cerr << '\n';
    return text;
  }
  std::string section(const HardCase& c) {
    std::string text = fmt::format(
        "\n## {}\n{}. `tests/hard_cases/{}.toml`{}, {:.3g} s.\n\n"
        "| solver | on | result | substeps | stretch | energy | inside | tunnelled | time |\n"
        "|---|---|---|---|---|---|---|---|---|\n",
        c.name, sentence(c.about), c.scene, settings(c), c.time_s);
    std::string refusing;
    for (const Solver* solver : solvers()) {
      if (what_solver_lacks(c, *solver).empty())
        text += rows(c, *solver);
      else
        refusing += fmt::format("{}{}", refusing.empty() ? "" : ", ", solver->name);
      std::cerr << '.' << std::flush;
    }
    if (!refusing.empty()) text += fmt::format("\nRefused, for want of passes, by {}.\n", refusing);
    return text;
  }
  std::string rows(const HardCase& c, const Solver& solver) {
    const Outcome on_cpu = run_hard_case(
        c, solver, [](const Model& m, const Solver& s) { return make_cpu_simulation(m, s, "f32"); });
    if (&solver == &held_solver(c)) draw(c, on_cpu);
    std::string text = row(c, solver, "CPU", on_cpu);
    if (native_lacks(hard_model(c), solver, "f32").empty())
      text += row(c, solver, "native", run_hard_case(c, solver, [](const Model& m, const Solver& s) {
                    return make_native_simulation(m, s, "f32");
                  }));
    if (solver.on_gpu)
      text +=
          row(c, solver, "device",
              run_hard_case(c, solver, [&](const Model& m, const Solver& s) -> std::unique_ptr<Simulation> {
                return GpuSimulation::create(device_, m, s, {.pipelines = pipelines_});
              }));
    return text;
  }
  static std::string sentence(std::string text) {
    text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
    return text;
  }
  static std::string settings(const HardCase& c) {
    std::string text;
    for (const std::string& set : c.set) text += fmt::format("{}`{}`", text.empty() ? " with " : ", ", set);
    return text;
  }
  void draw(const HardCase& c, const Outcome& outcome) {
    OffscreenRenderer renderer(
        device_, outcome.model,
        {.width = kTileWidth, .height = kTileHeight, .samples = 4, .camera = camera_for(outcome.end)});
    write_png(picture_of(c), renderer.draw(outcome.end));
  }
  static void place(const Picture& tile, std::uint32_t k, Picture& sheet) {
    const std::uint32_t left = k % kColumns * kTileWidth, top = k / kColumns * kTileHeight;
    for (std::uint32_t y = 0; y < tile.height; ++y)
      std::copy_n(&tile.rgba[std::size_t{y} * tile.width * 4], std::size_t{tile.width} * 4,
                  &sheet.rgba[(std::size_t{top + y} * sheet.width + left) * 4]);
  }

  fs::path docs_, parts_;
  gpu::Device device_;
  std::shared_ptr<GpuPipelines> pipelines_;
};

}  // namespace
}  // namespace weft::hard

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "usage: weft_stability DOCS_FOLDER PARTS_FOLDER DATE\n";
    return 2;
  }
  try {
    weft::hard::Page(argv[1], argv[2]).write(argv[3]);
  } catch (const weft::Error& failure) {
    std::cerr << failure.what() << '\n';
    return static_cast<int>(failure.code());
  }
  return 0;
}
