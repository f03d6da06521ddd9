// Taking, moving and letting go.
#include "viewer/hand.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace weft {

PinSection Hand::pin(const Grid& grid, std::uint32_t particle) {
  const std::uint32_t row = particle / grid.nx;
  const double i = particle % grid.nx, j = grid.own_row(row);
  // At least the particle itself, however coarse the grid.
  return {.at = {i / (grid.nx - 1), j / (grid.ny - 1)},
          .radius_m = std::max(kPatch_m, 0.1 * grid.spacing_m),
          .cloth = row / grid.ny};
}

void Hand::grab(const Model& before, const Model& with_pin, const State& state, const Pick& pick) {
  held_.clear();
  center_ = pick.particle;
  grip_ = target_ = pick.point;
  for (std::uint32_t p = 0; p < with_pin.grid.count(); ++p)
    if (with_pin.inverse_mass_at(p, state.time_s) == 0.0 && before.inverse_mass_at(p, state.time_s) != 0.0)
      held_.push_back({p, state.position[p] - grip_});
}

glm::dvec3 Hand::travel(double time_s) const {
  const glm::dvec3 way = target_ - grip_;
  const double length_m = glm::length(way), most_m = kSpeedMost_m_s * time_s;
  return length_m > most_m ? way * (most_m / length_m) : way;
}

std::uint32_t Hand::pieces(const Grid& grid, double frame_s, std::uint32_t substeps) const {
  const double cells = glm::length(travel(frame_s)) / (0.25 * grid.spacing_m);
  return static_cast<std::uint32_t>(std::clamp(std::ceil(cells), 1.0, static_cast<double>(substeps)));
}

std::vector<PlacedParticle> Hand::move(double time_s) {
  const glm::dvec3 moved = travel(time_s);
  const glm::dvec3 velocity = moved / time_s;
  grip_ += moved;
  std::vector<PlacedParticle> particles;
  for (const Held& held : held_)
    particles.push_back({held.particle, glm::vec3(grip_ + held.offset), glm::vec3(velocity)});
  return particles;
}

}  // namespace weft
