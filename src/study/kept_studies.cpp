// One folder a scene and device, one JSON file a time, written whole; what cannot be read is not there.
#include "study/kept_studies.h"

#include <fmt/format.h>

#include "core/cache.h"
#include "core/error.h"
#include "core/file.h"
#include "study/identity.h"

namespace weft::study {
namespace {

std::filesystem::path file_for(const std::filesystem::path& folder, double time_s) {
  return folder / fmt::format("{:.9g}.json", time_s);
}

std::optional<Study> load_study(const std::filesystem::path& file, const std::string& device) {
  std::error_code failure;
  if (!std::filesystem::is_regular_file(file, failure)) return {};
  try {
    Study study = study_from_json(read_file(file));
    if (study.device == device) return study;
  } catch (const std::exception&) {  // damaged or of another format
  }
  return {};
}

/// The part of a study that is of one resolution.
Study only(const Study& study, const Cloth& cloth) {
  Study part = study;
  part.cloths = {cloth};
  part.points = study.points_at(cloth.nx);
  return part;
}

}  // namespace

std::filesystem::path kept_folder(const Scene& scene, const std::string& device) {
  const std::filesystem::path folder = cache_folder();
  if (folder.empty()) return folder;
  return folder / "studies" /
         name_of(fmt::format("{}\n{}\n{}", kFormatVersion, device, canonical_scene(scene)));
}

void keep_study(const Scene& scene, const Study& study) {
  if (!study.complete) return;
  for (const Cloth& cloth : study.cloths) {
    Scene at_resolution = scene;
    at_resolution.cloth.resolution = cloth.nx;
    const std::filesystem::path folder = kept_folder(at_resolution, study.device);
    if (folder.empty() || !make_folder(folder)) return;
    const std::filesystem::path file = file_for(folder, study.time_s);
    const std::optional<Study> known = load_study(file, study.device);
    if (study.quick && known && !known->quick) continue;
    try {
      write_file(file, to_json(only(study, cloth)));
    } catch (const Error&) {
      return;
    }
  }
}

std::optional<Study> kept_study(const Scene& scene, const std::string& device, std::optional<double> time_s) {
  const std::filesystem::path folder = kept_folder(scene, device);
  if (folder.empty()) return {};
  if (time_s) return load_study(file_for(folder, *time_s), device);
  std::optional<Study> longest;
  std::error_code failure;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failure)) {
    auto study = load_study(entry.path(), device);
    if (study && (!longest || study->time_s > longest->time_s)) longest = std::move(study);
  }
  return longest;
}

Study study_for_choosing(const Bench& bench, const Scene& scene, double time_s, const Watch& watch) {
  if (auto kept = kept_study(scene, bench.label, time_s)) return std::move(*kept);
  SweepOptions options;
  options.time_s = time_s;
  options.quick = true;
  const std::filesystem::path folder = kept_folder(scene, bench.label);
  if (!folder.empty() && make_folder(folder)) options.records = folder / "points";
  Study study = run_study(bench, scene, options, watch);
  keep_study(scene, study);
  return study;
}

}  // namespace weft::study
