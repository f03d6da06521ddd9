// `--error` and `--budget`: the setting is chosen from the scene's study instead of being given.
#pragma once
#include <functional>
#include <string>

#include "cli/options.h"
#include "scene/scene.h"

namespace weft::cli {

/// The options with solver, substeps and precision as `--error` or `--budget` choose them from the study of
/// this scene, time and device (which is filled in where it is the default), run in quick form when there is
/// none; said on stderr. Unchanged when neither is given.
/// @param run_time_s  how long the scene will run [s]
/// @throws Error(Exit::usage) when no setting does what is asked (naming the nearest), or the options
///         contradict each other; Error(Exit::interrupted)
Options with_chosen_setting(const Options& asked, const std::string& scene_name,
                            const std::function<double(const Scene&)>& run_time_s);

}  // namespace weft::cli
