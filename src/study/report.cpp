// The report's files. PNG comes from the very SVG by a small script, so that there is one drawing.
#include "study/report.h"

#include <spawn.h>
#include <sys/wait.h>

#include "core/file.h"
#include "scene/reader.h"
#include "study/chart.h"

extern char** environ;

namespace weft::study {
namespace {

/// Runs `interpreter script svg png`, silent. Returns whether it ended well.
bool paint(const std::string& interpreter, const std::filesystem::path& script,
           const std::vector<std::filesystem::path>& svgs) {
  std::vector<std::string> words{interpreter, script.string()};
  for (const auto& svg : svgs) words.push_back(svg.string());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", 1, 0);
  posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", 1, 0);
  pid_t child = 0;
  const int failed = posix_spawnp(&child, interpreter.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  return failed == 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/// Makes x.png beside every x.svg. Returns why not, or nothing.
std::string paint_all(const std::vector<std::filesystem::path>& svgs) {
  const std::filesystem::path script = assets_dir() / "study" / "svg_to_png.py";
  for (const char* interpreter : {"python3", "/usr/bin/python3"})  // the system's has the system's matplotlib
    if (paint(interpreter, script, svgs)) return "";
  return "python3 with matplotlib is not there (Debian: python3-matplotlib)";
}

}  // namespace

ReportFiles write_report(const std::filesystem::path& folder, const Study& study) {
  ReportFiles files;
  const auto write = [&](const std::string& name, const std::string& bytes) {
    write_file(folder / name, bytes);
    files.written.push_back(folder / name);
  };
  write("points.csv", points_csv(study.points));
  write("points.json", to_json(study));
  write("report.html", report_html(study));
  std::vector<std::filesystem::path> svgs;
  for (const Cloth& cloth : study.cloths) {
    const std::string name = "work-precision-" + std::to_string(cloth.nx);
    write(name + ".svg", work_precision_svg(study, cloth.nx, CostAxis::device_time));
    svgs.push_back(files.written.back());
    write(name + "-springs.svg", work_precision_svg(study, cloth.nx, CostAxis::spring_evaluations));
    svgs.push_back(files.written.back());
  }
  files.png_missing = paint_all(svgs);
  if (files.png_missing.empty())
    for (std::filesystem::path svg : svgs) files.written.push_back(svg.replace_extension(".png"));
  return files;
}

}  // namespace weft::study
