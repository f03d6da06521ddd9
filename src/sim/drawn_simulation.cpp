// What every drawn simulation checks before it changes under way.
#include "sim/drawn_simulation.h"

#include <algorithm>

#include "core/error.h"

namespace weft {

bool same_commands(const Plan& a, const Plan& b) {
  const auto same_step = [](const PlanStep& x, const PlanStep& y) {
    const auto same_constant = [](const Constant& c, const Constant& d) {
      return c.name == d.name && c.value == d.value;
    };
    return x.pass == y.pass && x.block == y.block && x.range.x == y.range.x && x.range.y == y.range.y &&
           x.range.offset == y.range.offset && x.row == y.row && x.interval == y.interval &&
           x.item == y.item && std::ranges::equal(x.constants, y.constants, same_constant);
  };
  const auto same_buffer = [](const PlanBuffer& x, const PlanBuffer& y) {
    return x.id == y.id && x.bytes == y.bytes;
  };
  return a.solver == b.solver && a.sheet_rows == b.sheet_rows &&
         std::ranges::equal(a.steps, b.steps, same_step) &&
         std::ranges::equal(a.buffers, b.buffers, same_buffer);
}

void require_pinned(const Model& model, std::span<const PlacedParticle> particles) {
  for (const PlacedParticle& placed : particles)
    if (model.relative_inverse_mass.at(placed.particle) != 0.0)
      throw error(Exit::internal, "particle {} is to be placed but is not pinned", placed.particle);
}

}  // namespace weft
