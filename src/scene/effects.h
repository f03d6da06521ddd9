// The effects that a scene may call for, each by name: how to add one weakly, how to leave one out. What
// shows or measures an effect's cost, and the tests that what is left out costs nothing, follow from this
// list.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace weft {

/// How far below the cloth a collider stands that an effect adds [m]: nothing falls so far in a benchmark.
inline constexpr double kEffectFar_m = 100.0;

struct Effect {
  std::string_view name;   ///< an optional section of a scene file ("air"), or a key of [material] ("bend")
  std::string_view needs;  ///< the effect without which it does nothing ("air" for "wind"); empty: none
  /// Calls for it in a scene that has not got it, such that it is in the plan and has nothing to do:
  /// colliders far away, a thickness below the cells' size. What it needs must be there.
  void (*add)(Scene&);
  /// Takes it out where it is a key of [material]; nullptr for a section.
  void (*remove)(Scene&) = nullptr;
  bool (*present)(const Scene&) = nullptr;  ///< likewise
  std::string_view solver = {};             ///< the only one that has it; empty: leapfrog has it
  std::string_view not_with = {};           ///< an effect that it cannot stand beside
};

/// Every effect, in the order of the scene file.
std::span<const Effect> effects();

/// @throws Error(Exit::internal) for a name that is none
const Effect& find_effect(std::string_view name);

/// Whether a scene can have both and leapfrog can run it.
bool stand_together(const Effect&, const Effect&);

/// Whether the scene calls for it.
bool has_effect(const Scene&, const Effect&);

/// Those of effects() that the scene calls for.
std::vector<std::string> effects_of(const Scene&);

/// The scene with an effect, and with what that needs. An effect that is there stays as it is.
Scene with_effect(Scene, std::string_view effect);

/// The scene without an effect, and without what needs it.
Scene without_effect(Scene, std::string_view effect);

}  // namespace weft
