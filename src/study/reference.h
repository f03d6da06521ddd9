// The converged reference that errors are measured against, with the floors below which a comparison means
// nothing; kept on disk, since it takes longer than what it judges.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "study/trajectory.h"

namespace weft::study {

struct ReferenceOptions {
  double tolerance_m = 1e-9;     ///< two successive refinements shall agree to this
  std::uint32_t levels_min = 2;  ///< even if fewer agree: so that a tenth of a fine rk4's error is known
  std::uint32_t levels_max = 8;  ///< of substeps, each with twice those of the one before
  double seconds = 600.0;        ///< no further level is begun that would end later than this
  bool discretisation = true;    ///< also run the cloth at twice the resolution
  std::uint64_t memory_bytes = std::uint64_t{2} << 30;  ///< for the trajectories held at a time
};

/// Why refinement ended: agreed, or it stopped helping (twins drift apart faster), or time or levels ran out.
enum class Ending { agreed, no_gain, out_of_time };

struct Reference {
  std::string solver = "rk4";  ///< that was refined
  std::uint32_t substeps = 0;  ///< of the finest level
  double agreement_m = 0;      ///< error between the two finest levels
  Ending ending = Ending::agreed;
  double twin_m = 0;             ///< largest RMS drift of a double-precision run started 1e-7 m apart
  double float_floor_m = 0;      ///< leapfrog (or `solver`, where that cannot run the scene) in f32 against
                                 ///< itself at half the step, where that is least
  double discretisation_m = -1;  ///< against the same cloth at twice the resolution; −1: not measured
  std::uint32_t fine_nx = 0;     ///< that resolution
  double allowed_s = 0;          ///< ReferenceOptions::seconds it was made with
  Trajectory frames;
};

inline constexpr double kTwinStart_m = 1e-7;  ///< RMS distance between the twins' starts

/// The start with every free particle displaced, in directions of a fixed sequence, so that the RMS over all
/// particles is `distance_m`.
State perturbed_start(const Model& model, double distance_m);

/// What a scene's reference is computed with: rk4, or the first solver that has the passes of its effects.
const Solver& reference_solver(const Model& model);

/// Runs reference_solver in double at 1, 2, 4, … times its automatic substeps until two levels agree.
/// @param note  told what is computed
/// @throws Error(Exit::interrupted); Error(Exit::diverged) when the reference itself leaves the finite
/// numbers
Reference make_reference(const Model& model, double time_s, const ReferenceOptions& options, const Stop& stop,
                         const std::function<void(const std::string&)>& note);

/// make_reference, or what an earlier one left in the cache if it is at least as good. A damaged, foreign or
/// older file is ignored and replaced; a cache that cannot be written is no failure.
Reference find_reference(const Model& model, double time_s, const ReferenceOptions& options, const Stop& stop,
                         const std::function<void(const std::string&)>& note);

/// The reference that find_reference left in the cache; nothing when there is none that can be read.
std::optional<Reference> kept_reference(const Model& model, double time_s);

/// Where find_reference keeps it; empty when there is no cache folder.
std::filesystem::path reference_file(const Model& model, double time_s);

/// The file's bytes: a line of JSON, the states in double, a checksum.
std::string to_bytes(const Reference& reference, std::string_view identity);

/// Back from bytes; nothing when they are damaged or belong to another identity.
std::optional<Reference> from_bytes(std::string_view bytes, std::string_view identity);

/// "agreed", "no gain", "out of time".
std::string_view name_of(Ending ending);

}  // namespace weft::study
