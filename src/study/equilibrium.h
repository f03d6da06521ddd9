// The shape in which a hanging cloth comes to rest: the minimum of its energy, by Newton's method.
#pragma once
#include <string>
#include <vector>

#include "model/model.h"
#include "study/trajectory.h"

namespace weft::study {

struct Equilibrium {
  std::vector<glm::dvec3> position;  ///< [m], shape [count]; empty when there is none
  double residual_n = 0;             ///< largest force on a free particle
  std::uint32_t iterations = 0;
  std::string reason;  ///< why there is none
  bool found() const { return !position.empty(); }
};

inline constexpr double kRestForce_n = 1e-9;  ///< largest force on a free particle at rest

/// Minimises elastic, bending and gravity energy from `start` by truncated Newton steps in a trust region,
/// the systems solved by conjugate gradients, until no force is above kRestForce_n.
/// Pinned particles stay. A cloth with nothing pinned, in a wind, or whose rest would touch a collider has
/// none; `reason` then says so.
/// @throws Error(Exit::interrupted)
/// Source: Steihaug, The conjugate gradient method and trust regions in large scale optimization, SIAM J.
/// Numer. Anal. 20 (1983), algorithm 2.1.
Equilibrium find_equilibrium(const Model& model, const State& start, const Stop& stop);

}  // namespace weft::study
