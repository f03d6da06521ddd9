// `weft view`, also plain `weft`: the window. The one place where src/viewer is hooked in; CMake defines
// WEFT_HAS_VIEWER when it builds the library weft_viewer.
#include "cli/choose.h"
#include "cli/command.h"
#include "cli/setup.h"
#ifdef WEFT_HAS_VIEWER
#include "viewer/viewer.h"
#endif

namespace weft::cli {
namespace {

#ifdef WEFT_HAS_VIEWER
Exit run_view(const Options& o) {
  refuse_second_scene(o);
  if (o.on_native()) refuse_vulkan_options(o, true);  // cpu is refused with words of its own
  ViewerOptions window;
  if (!o.scenes.empty())
    find_scene(o.scenes.front());  // a slip of the keyboard is said without a display, too
  if (!o.scenes.empty()) window.scene = o.scenes.front();
  const Options chosen =
      with_chosen_setting(o, window.scene, [&](const Scene&) { return o.time_or_default_s(); });
  window.overrides = overrides_of(chosen);
  window.device = chosen.device;
  window.kernel = o.kernel;
  window.validation = o.validation;
  window.force_staging = o.force_staging;
  window.shader_dir = o.shaders;
  return static_cast<Exit>(run_viewer(window));
}
#else
/// @throws Error(Exit::usage), after checking that the word is a scene: a mistyped command is said to be one
Exit run_view(const Options& o) {
  refuse_second_scene(o);
  if (!o.scenes.empty()) find_scene(o.scenes.front());
  const std::string scene = o.scenes.empty() ? "1" : o.scenes.front();
  throw error(Exit::usage,
              "the window is not part of this build; instead, `weft render {0} --out picture.png "
              "--time 2` draws, `weft simulate {0}` computes, and `weft --help` lists every command",
              scene);
}
#endif

void add_view_options(CLI::App& app, Options& o) {
  add_scene(app, o);
  add_choice_options(app, o);
}

}  // namespace

const Command view_command{"view", "opens the window (also plain `weft`)", "  weft\n  weft view 5",
                           add_view_options, run_view};

}  // namespace weft::cli
