// The options that the commands share: what was asked for, already checked value by value.
#pragma once
#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace weft::cli {

enum class Format { human, json, csv };

/// How `--size` and its neighbours want the picture; absent ones follow the renderer's defaults.
struct PictureOptions {
  std::uint32_t width = 1280, height = 720;
  std::optional<std::uint32_t> samples;  ///< 1 or 4 a pixel; absent: the device decides
  bool flat = false;
  bool wireframe = false;
  std::optional<std::uint32_t> fps;  ///< absent: one picture a frame, 60 at most
};

/// What `study` sweeps; empty lists: all there is.
struct StudyOptions {
  bool quick = false;
  std::vector<std::uint32_t> resolutions;
  std::vector<std::string> solvers, precisions;
};

/// One command line. Scene keys (`--set`, `--resolution`, …) stay TOML assignments for the scene reader.
struct Options {
  std::vector<std::string> scenes;
  std::string device;                       ///< name, index, UUID, cpu, native; empty: the first device
  std::vector<std::string> set;             ///< `--set`, in order
  std::optional<std::string> material;      ///< `--material`
  std::optional<std::string> solver;        ///< `--solver`
  std::optional<std::uint32_t> resolution;  ///< `--resolution`
  std::optional<std::uint32_t> substeps;    ///< `--substeps`; 0 = auto
  std::optional<std::string> precision;     ///< `--precision`
  std::optional<double> frame_s;            ///< `--frame`
  std::optional<double> time_s;             ///< `--time`
  std::optional<double> error_m;            ///< `--error`: choose the cheapest setting below it
  std::optional<double> budget_ms;          ///< `--budget`: choose the most accurate within it, ms a frame
  std::string kernel;                       ///< `--kernel`; empty: WEFT_KERNEL, else auto
  std::filesystem::path shaders;            ///< `--shaders`; empty: the embedded modules
  Format format = Format::human;
  bool validation = false, force_staging = false, quiet = false, verbose = false, check = false;
  std::optional<std::filesystem::path> out;
  bool effects = false;                   ///< `bench` only: what each effect costs
  std::vector<std::string> only_effects;  ///< `bench --effects` only: of these; empty: of all
  PictureOptions picture;
  StudyOptions study;
  std::string command_line;  ///< as typed, for reports
  std::string perturb;       ///< PASS.CONSTANT, `validate` only

  bool on_cpu() const { return device == "cpu"; }        ///< the reference
  bool on_native() const { return device == "native"; }  ///< the CPU's vector units
  bool on_vulkan() const { return !on_cpu() && !on_native(); }
  /// `--time`, else 5 s.
  double time_or_default_s() const { return time_s.value_or(5.0); }
};

inline constexpr double kTimeMax_s = 1e6;  ///< longest `--time`: 11 days of cloth

/// Adds the options every command takes. Values are checked as they are read.
void add_shared_options(CLI::App&, Options&);

/// Adds SCENE: one (only_scene or refuse_second_scene sees to that), or any number of them.
void add_scene(CLI::App&, Options&);
void add_scenes(CLI::App&, Options&);

/// Adds `--out`; `about` says what may be written.
void add_out(CLI::App&, Options&, const std::string& about);

/// Adds the options of `render`.
void add_picture_options(CLI::App&, Options&);

/// Adds `--error` and `--budget`.
void add_choice_options(CLI::App&, Options&);

/// Adds SCENE and the options of `bench`.
void add_bench_options(CLI::App&, Options&);

/// Adds the options of `study`.
void add_study_options(CLI::App&, Options&);

/// The one scene a command needs.
/// @throws Error(Exit::usage) when none was given, or a second one
const std::string& only_scene(const Options&);

/// @throws Error(Exit::usage) when more than one scene was given
void refuse_second_scene(const Options&);

}  // namespace weft::cli
