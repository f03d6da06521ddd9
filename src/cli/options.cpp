// Declares the shared options to CLI11. Every value arrives as text and is checked here, so that messages
// name the option, the value, the rule and the cure.
#include "cli/options.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "cli/text.h"
#include "core/error.h"
#include "core/text.h"
#include "scene/parameters.h"
#include "scene/reader.h"

namespace weft::cli {
namespace {

using namespace std::string_view_literals;

constexpr std::array kFormats = {"human"sv, "json"sv, "csv"sv};
constexpr std::array kPrecisions = {"f32"sv, "f32k"sv, "f64"sv};
constexpr std::array kKernels = {"direct"sv, "texel"sv, "strip"sv, "steal"sv, "bands"sv, "auto"sv, "all"sv};
constexpr std::array kShadings = {"smooth"sv, "flat"sv};

/// The allowed range of a scene key, from the one table of parameters.
const Parameter& scene_key(std::string_view section, std::string_view key) {
  const Parameter* row = find_parameter(section, key);
  if (row == nullptr) throw error(Exit::internal, "the parameter table lacks {}.{}", section, key);
  return *row;
}

std::uint32_t parse_scene_count(std::string_view option, std::string_view text, std::string_view section,
                                std::string_view key, std::string_view cure) {
  const Parameter& row = scene_key(section, key);
  return parse_count(option, text, static_cast<std::uint32_t>(std::max(1.0, row.minimum)),
                     static_cast<std::uint32_t>(row.maximum), cure);
}

/// One of the words that a scene key may be.
std::string parse_scene_word(std::string_view option, const std::string& text, std::string_view section,
                             std::string_view key) {
  std::vector<std::string_view> words;
  for (std::string_view left = scene_key(section, key).words; !left.empty();) {
    words.push_back(left.substr(0, left.find('|')));
    left.remove_prefix(std::min(words.back().size() + 1, left.size()));
  }
  parse_word(option, text, words);
  return text;
}

void add_text(CLI::App& app, const std::string& name, const std::string& about, const std::string& value_name,
              const std::function<void(const std::string&)>& take) {
  app.add_option_function<std::string>(name, take, about)->type_name(value_name);
}

void add_scene_key_options(CLI::App& app, Options& o) {
  add_text(app, "--resolution", "particles along the width", "N", [&o](const std::string& text) {
    o.resolution = parse_scene_count("--resolution", text, "cloth", "resolution", "--resolution 64");
  });
  add_text(app, "--material", "a preset of `weft materials` instead of the scene's", "NAME",
           [&o](const std::string& text) {
             std::vector<std::string> names;
             for (const AssetInfo& material : list_materials()) names.push_back(material.name);
             parse_word("--material", text, std::vector<std::string_view>(names.begin(), names.end()));
             o.material = text;
           });
  add_text(app, "--solver", "one of `weft solvers`", "NAME", [&o](const std::string& text) {
    o.solver = parse_scene_word("--solver", text, "solver", "name");
  });
  add_text(app, "--substeps", "substeps a frame, or auto (from the stable step)", "N|auto",
           [&o](const std::string& text) {
             o.substeps = text == "auto" ? 0
                                         : parse_scene_count("--substeps", text, "solver", "substeps",
                                                             "--substeps 200, or --substeps auto");
           });
  add_text(app, "--precision", "f32, f32k (compensated) or f64", "NAME", [&o](const std::string& text) {
    o.precision = std::string(kPrecisions[parse_word("--precision", text, kPrecisions)]);
  });
  add_text(app, "--frame", "length of a frame [s]; default 1/60", "SECONDS", [&o](const std::string& text) {
    const Parameter& row = scene_key("solver", "frame");
    o.frame_s = parse_number("--frame", text, row.minimum, row.maximum, "s", "--frame 0.02");
  });
  app.add_option("--set", o.set, "any scene key, as often as needed: section.key=value (TOML)")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

std::filesystem::path checked_folder(const std::string& text) {
  std::error_code failure;
  if (std::filesystem::is_directory(text, failure)) return text;
  throw error(Exit::usage,
              "--shaders is {}; it must be a folder that holds passes/ and draw/ (this source's "
              "own is shaders/)",
              in_quotes(text));
}

void parse_size(const std::string& text, PictureOptions& picture) {
  const std::size_t cross = text.find('x');
  const std::string cure = "--size 1280x720";
  if (cross == std::string::npos)
    throw error(Exit::usage, "--size is {}; it must be WIDTHxHEIGHT in pixels (for example {})",
                in_quotes(text), cure);
  picture.width = parse_count("--size's width", text.substr(0, cross), 16, 16384, cure);
  picture.height = parse_count("--size's height", text.substr(cross + 1), 16, 16384, cure);
}

/// The parts of "a,b,c".
/// @throws Error(Exit::usage) when one is empty
std::vector<std::string> parse_list(std::string_view option, const std::string& text, std::string_view cure) {
  std::vector<std::string> parts{""};
  for (const char c : text) {
    if (c == ',')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  if (std::find(parts.begin(), parts.end(), "") != parts.end())
    throw error(Exit::usage, "{} is {}; it must be a list with commas (for example {})", option,
                in_quotes(text), cure);
  return parts;
}

}  // namespace

void add_shared_options(CLI::App& app, Options& o) {
  add_text(app, "--device", "any part of a device's name, its index, its UUID, cpu or native", "NAME",
           [&o](const std::string& text) {
             if (text.empty())
               throw Error(Exit::usage, "--device is empty; give a name, an index, a UUID, cpu or native");
             const std::string lower = in_lower_case(text);  // device names ignore case
             o.device = lower == "cpu" || lower == "native" ? lower : text;
           });
  add_scene_key_options(app, o);
  add_text(app, "--time", "how long to simulate [s]; default 5", "SECONDS", [&o](const std::string& text) {
    o.time_s = parse_number("--time", text, 0.0, kTimeMax_s, "s", "--time 2.5");
  });
  add_text(app, "--format", "human, json or csv", "NAME", [&o](const std::string& text) {
    o.format = static_cast<Format>(parse_word("--format", text, kFormats));
  });
  add_text(app, "--kernel",
           "direct, texel, strip, steal, bands, auto (the fastest; default), all (bench only)", "NAME",
           [&o](const std::string& text) { o.kernel = kKernels[parse_word("--kernel", text, kKernels)]; });
  add_text(app, "--shaders", "compile the shaders of this folder instead of the built-in ones", "DIR",
           [&o](const std::string& text) { o.shaders = checked_folder(text); });
  app.add_flag("--validation", o.validation, "run under the Vulkan validation layer; a message is a failure");
  app.add_flag("--force-staging", o.force_staging,
               "copy through staging buffers even where memory is visible");
  app.add_flag("-q,--quiet", o.quiet, "no progress, no warnings");
  app.add_flag("-v,--verbose", o.verbose, "say more, on stderr");
  app.set_version_flag("--version", "weft " WEFT_VERSION);
}

void add_scene(CLI::App& app, Options& o) {
  app.add_option("SCENE", o.scenes, "1 to 6, a name of `weft scenes`, or a path")->type_name("");
}

void add_scenes(CLI::App& app, Options& o) {
  app.add_option("SCENE", o.scenes, "any number of: 1 to 6, names of `weft scenes`, or paths")->type_name("");
}

void add_out(CLI::App& app, Options& o, const std::string& about) {
  add_text(app, "--out", about, "FILE", [&o](const std::string& text) {
    if (text.empty()) throw Error(Exit::usage, "--out is empty; give the file to write");
    o.out = text;
  });
}

void add_picture_options(CLI::App& app, Options& o) {
  add_text(app, "--size", "picture size in pixels; default 1280x720", "WxH",
           [&o](const std::string& text) { parse_size(text, o.picture); });
  add_text(app, "--samples", "1 or 4 samples a pixel", "N", [&o](const std::string& text) {
    constexpr std::array kSamples = {"1"sv, "4"sv};
    o.picture.samples = parse_word("--samples", text, kSamples) == 0 ? 1u : 4u;
  });
  add_text(app, "--shading", "smooth, or flat (draws half of the triangles)", "NAME",
           [&o](const std::string& text) { o.picture.flat = parse_word("--shading", text, kShadings) == 1; });
  app.add_flag("--wireframe", o.picture.wireframe, "draw the triangles' edges");
  add_text(app, "--fps", "pictures a simulated second; default one a frame, at most 60", "N",
           [&o](const std::string& text) { o.picture.fps = parse_count("--fps", text, 1, 240, "--fps 30"); });
}

void add_choice_options(CLI::App& app, Options& o) {
  add_text(app, "--error", "choose the cheapest solver and substeps whose measured error is below [m]",
           "METRES", [&o](const std::string& text) {
             o.error_m = parse_number("--error", text, 1e-15, 1e3, "m", "--error 1e-3");
           });
  add_text(app, "--budget", "choose the most accurate solver and substeps that fit [ms a frame]", "MS",
           [&o](const std::string& text) {
             o.budget_ms = parse_number("--budget", text, 1e-6, 1e9, "ms", "--budget 8");
           });
}

void add_bench_options(CLI::App& app, Options& o) {
  add_scenes(app, o);
  app.add_flag("--effects", o.effects, "what each effect costs: the scene with it and without it, by turns");
  add_text(app, "--only", "with --effects: these alone; default all of them", "NAME,NAME,...",
           [&o](const std::string& text) {
             o.only_effects = parse_list("--only", text, "--only capsules,boxes");
           });
}

void add_study_options(CLI::App& app, Options& o) {
  app.add_flag("--quick", o.study.quick, "fewer points and runs: at most two minutes");
  add_text(app, "--resolutions", "particles along the width; default the scene's (with --quick at most 33)",
           "N,N,...", [&o](const std::string& text) {
             for (const std::string& part : parse_list("--resolutions", text, "--resolutions 20,40"))
               o.study.resolutions.push_back(
                   parse_scene_count("--resolutions", part, "cloth", "resolution", "--resolutions 20,40"));
           });
  add_text(app, "--solvers", "of `weft solvers`; default all", "NAME,NAME,...",
           [&o](const std::string& text) {
             o.study.solvers = parse_list("--solvers", text, "--solvers leapfrog,rk4");
             for (const std::string& name : o.study.solvers)
               parse_scene_word("--solvers", name, "solver", "name");
           });
  add_text(app, "--precisions", "of f32, f32k and f64; default all", "NAME,NAME,...",
           [&o](const std::string& text) {
             o.study.precisions = parse_list("--precisions", text, "--precisions f32,f64");
             for (const std::string& name : o.study.precisions) parse_word("--precisions", name, kPrecisions);
           });
}

const std::string& only_scene(const Options& o) {
  if (o.scenes.empty())
    throw Error(Exit::usage,
                "no scene is given; it must be 1 to 6, a name of `weft scenes`, or a path "
                "(for example `weft simulate 1 --time 2`)");
  refuse_second_scene(o);
  return o.scenes.front();
}

void refuse_second_scene(const Options& o) {
  if (o.scenes.size() > 1)
    throw error(Exit::usage, "{} is one argument too many; this command takes one scene",
                in_quotes(o.scenes[1]));
}

}  // namespace weft::cli
