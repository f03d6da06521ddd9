// Small cloths, synthetic points and a cache folder of its own for the study's tests.
#pragma once
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "study/study.h"

namespace weft::study {

/// A cloth of 9 × 9 particles held by two corners, with gravity: stiff enough to need a few substeps.
inline Scene small_scene() {
  Scene scene;
  scene.title = "small";
  scene.source = "small.toml";
  scene.cloth.resolution = 9;
  scene.cloth.imperfection_m = 0.01;
  scene.material.membrane_n_m = 100.0;
  scene.material.bend_n_m = 1e-4;
  scene.pins = {PinSection{{0.0, 0.0}, 0.05}, PinSection{{1.0, 0.0}, 0.05}};
  scene.gravity.emplace();
  return scene;
}

inline Point point_of(double ms_per_s, double error_m, bool diverged = false) {
  Point point;
  point.ms_per_s = ms_per_s;
  point.error_m = error_m;
  point.diverged = diverged;
  return point;
}

/// Random points over four decades each, some equal in cost or error, some diverged.
inline std::vector<Point> random_points(std::mt19937_64& random) {
  std::uniform_int_distribution<int> count(0, 30), grid(0, 12), tenth(0, 9);
  std::vector<Point> points;
  for (int left = count(random); left > 0; --left) {
    const double cost = std::pow(10.0, grid(random) / 3.0), error_m = std::pow(10.0, -grid(random) / 3.0);
    points.push_back(point_of(cost, error_m, tenth(random) == 0));
  }
  return points;
}

/// An empty folder, removed at the end; the cache lives in it meanwhile.
class ScratchCache {
 public:
  ScratchCache() {
    std::string name = (std::filesystem::temp_directory_path() / "weft-study-XXXXXX").string();
    folder_ = mkdtemp(name.data());
    if (const char* known = std::getenv("XDG_CACHE_HOME")) before_ = known;
    setenv("XDG_CACHE_HOME", folder_.c_str(), 1);
  }
  ~ScratchCache() {
    if (before_.empty())
      unsetenv("XDG_CACHE_HOME");
    else
      setenv("XDG_CACHE_HOME", before_.c_str(), 1);
    std::error_code failure;
    std::filesystem::remove_all(folder_, failure);
  }
  ScratchCache(const ScratchCache&) = delete;
  ScratchCache& operator=(const ScratchCache&) = delete;
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
  std::string before_;
};

}  // namespace weft::study
