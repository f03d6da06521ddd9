// A hand that pulls cloth: a small patch that the model pins for as long as it is held, following the pointer
// at a bounded speed. The pin is one like any other in the plan; the hand puts its particles in place.
#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "model/model.h"
#include "sim/gpu_simulation.h"
#include "viewer/pick.h"

namespace weft {

class Hand {
 public:
  static constexpr double kPatch_m = 0.02;       ///< radius of what is held, on the flat cloth
  static constexpr double kSpeedMost_m_s = 4.0;  ///< of the hand; a faster pointer is followed late

  bool holds() const { return !held_.empty(); }
  std::uint32_t center() const { return center_; }
  /// The pin that holds the cloth around the particle picked.
  static PinSection pin(const Grid& grid, std::uint32_t particle);
  /// Takes what `with_pin` pins and `before` does not, the models with and without the hand's pin.
  void grab(const Model& before, const Model& with_pin, const State& state, const Pick& pick);
  /// Where the point that was picked should go [m].
  void pull_to(const glm::dvec3& point) { target_ = point; }
  const glm::dvec3& grip() const { return grip_; }
  void let_go() { held_.clear(); }

  /// How many short frames one frame must become, so that the hand moves at most a quarter of a cell in each.
  std::uint32_t pieces(const Grid& grid, double frame_s, std::uint32_t substeps) const;
  /// Moves the hand for `time_s` and tells where its particles are now.
  std::vector<PlacedParticle> move(double time_s);

 private:
  struct Held {
    std::uint32_t particle;
    glm::dvec3 offset;  ///< from the grip [m]
  };
  glm::dvec3 travel(double time_s) const;

  std::vector<Held> held_;
  std::uint32_t center_ = 0;
  glm::dvec3 grip_{0.0}, target_{0.0};
};

}  // namespace weft
