// What a run that has diverged says: where, when, how fast, and why probably.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/error.h"
#include "model/model.h"
#include "plan/plan.h"

namespace weft {

struct Divergence {
  std::uint64_t frame = 0;     ///< the first unsound one, counted since the latest state was written; 0: that
  std::uint32_t particle = 0;  ///< the first that is not finite, else the fastest
  double speed_m_s = 0.0;      ///< its speed; NaN when it is not finite
  double energy_share = 0.0;   ///< kinetic energy over what the scene can have given, of which 16 times is
                               ///< allowed and 32 times told apart; 0 when not finite
  double time_s = 0.0;         ///< at the frame's end
  std::uint32_t substeps = 0;  ///< that its frame took
  double frame_s = 0.0;        ///< and how long that frame was
};

/// What the words of watch_state say; nothing while the simulation is sound.
std::optional<Divergence> divergence_in(std::span<const std::uint32_t> watch_state);

/// Why, in words: a solver unstable by nature, too few substeps, or else the scene.
std::string likely_cause(const Divergence&, const Model&, const Plan&);

/// One sentence without the cure: "after frame 12 particle 70 (i = 6, j = 1) is not finite".
std::string what_happened(const Divergence&, const Model&);

/// Exit 4, with what happened and why.
/// @param saved  what became of the last good state; may be empty
Error divergence_error(const Divergence&, const Model&, const Plan&, const std::string& saved);

}  // namespace weft
