// Studies kept on disk, so that a setting can be chosen, and a panel filled, without measuring anew.
#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "study/study.h"

namespace weft::study {

/// The folder of a scene (at its resolution) on a device; empty without a cache folder. One file a time.
std::filesystem::path kept_folder(const Scene& scene, const std::string& device);

/// Keeps a complete study for every resolution in it. A quick one never replaces one that is not; a cache
/// that cannot be written is no failure.
void keep_study(const Scene& scene, const Study& study);

/// The study of this scene, at its resolution, on this device and over `time_s`.
/// @param time_s  absent: over whatever time; the longest there is
std::optional<Study> kept_study(const Scene& scene, const std::string& device, std::optional<double> time_s);

/// kept_study, else a quick one, which is then kept; its finished points survive an interruption.
Study study_for_choosing(const Bench& bench, const Scene& scene, double time_s, const Watch& watch);

}  // namespace weft::study
