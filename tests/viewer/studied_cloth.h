// A small cloth with a study made by hand, and a cache folder of its own.
#pragma once
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "gpu_fixture.h"
#include "scene/reader.h"
#include "study/kept_studies.h"

namespace weft::test {

/// The cache in an empty folder while in scope.
class ScratchCache {
 public:
  ScratchCache() : folder_(made()), environment_("XDG_CACHE_HOME", folder_.string()) {}
  ~ScratchCache() {
    std::error_code failure;
    std::filesystem::remove_all(folder_, failure);
  }
  ScratchCache(const ScratchCache&) = delete;
  ScratchCache& operator=(const ScratchCache&) = delete;
  const std::filesystem::path& folder() const { return folder_; }

 private:
  static std::filesystem::path made() {
    std::string name = (std::filesystem::temp_directory_path() / "weft-panel-XXXXXX").string();
    return mkdtemp(name.data());
  }
  std::filesystem::path folder_;
  ScopedEnvironment environment_;
};

inline study::Point studied_point(const std::string& solver, std::uint32_t substeps, double ms_per_s,
                                  double error_m) {
  study::Point point;
  point.setting = {solver, "f32", substeps};
  point.nx = point.ny = 17;
  point.ms_per_s = ms_per_s;
  point.error_m = error_m;
  return point;
}

/// Two solvers and one setting that diverged; the reference is known to 1e-7 m.
inline study::Study hand_made_study(const Scene& scene, const std::string& device) {
  study::Study study;
  study.title = scene.title;
  study.device = device;
  study.date = "2026-11-22 00:00 UTC";
  study.time_s = 0.5;
  study.frame_s = scene.solver.frame_s;
  study.complete = study.quick = true;
  study::Cloth cloth;
  cloth.nx = cloth.ny = 17;
  cloth.agreement_m = 1e-7;
  cloth.twin_m = 1e-6;
  cloth.float_floor_m = 3e-7;
  study.cloths = {cloth};
  study.points = {studied_point("leapfrog", 40, 100.0, 1e-3), studied_point("leapfrog", 80, 200.0, 2.5e-4),
                  studied_point("leapfrog", 160, 400.0, 6e-5), studied_point("rk4", 40, 800.0, 1e-6),
                  studied_point("verlet", 20, 50.0, 0.0)};
  study.points.back().diverged = true;
  return study;
}

/// A scene file of 17 × 17 particles in that folder.
inline std::string small_scene_file(const std::filesystem::path& folder) {
  const std::string file = (folder / "small.toml").string();
  std::ofstream(file) << "title = \"small\"\n[cloth]\nresolution = 17\n[gravity]\n[air]\ndrag = 0.1\n"
                         "[[pins]]\nat = [0.0, 0.0]\n";
  return file;
}

}  // namespace weft::test
