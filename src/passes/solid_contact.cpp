// solid_contact: capsules, boxes and a tilted floor push out what a drift brought into them. Declaration and
// CPU mirror.
#include "passes/ground.h"
#include "passes/passes.h"
#include "passes/reach.h"
#include "passes/substep.h"

namespace weft {
namespace {

Range domain(const Model& m) { return solid_count(m) > 0 || has_tilted_floor(m) ? whole_cloth(m) : Range{}; }

Constants constants(const Model& m) {
  const RowLayout at = row_layout(m);
  const bool tilted = has_tilted_floor(m);
  return {{"solids", solid_count(m)},
          {"solid rows", solid_count(m) > 0 ? at.solids : 0},
          {"floor", m.scene.floor && !tilted},
          {"tilted floor", tilted ? at.floor : 0}};
}

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  if (!take_reach(context.model, buffers, shared::kReachSolids)) return;
  const SubstepRow<T> row = substep_row<T>(context.model, context.row);
  const Ground<T> ground(context.model);
  const Grid& grid = context.model.grid;
  auto& position = buffers[BufferId::position];
  auto& velocity = buffers[BufferId::velocity];
  const auto& before = std::as_const(buffers)[BufferId::position_next];
  parallel_rows(grid.rows(), grid.nx, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t p = begin * grid.nx; p < end * grid.nx; ++p) {
      if (position[p].w == T(0)) continue;
      Vec3<T> x1 = xyz(position[p]), v = xyz(velocity[p]);
      for (const SolidRow<T>& solid : row.solids) solid_touch(solid, xyz(before[p]), x1, v);
      ground.touch(x1, v);
      position[p] = glm::vec<4, T>(x1, position[p].w);
      velocity[p] = glm::vec<4, T>(v, T(0));
    }
  });
}

}  // namespace

const Pass solid_contact{
    .name = "solid_contact",
    .about = "contact with capsules, boxes and a tilted floor, then the floor again",
    .domain = domain,
    .constants = constants,
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
    .reach_word = [](std::uint32_t) { return shared::kReachSolids; },
};

}  // namespace weft
