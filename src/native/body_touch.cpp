// A particle near a mesh is searched by itself, as is one whose path may have gone deep into a body.
#include "native/body_touch.h"

#include <algorithm>
#include <span>

#include "passes/mesh_grids.h"
#include "passes/passes.h"

namespace weft::native {
namespace {

glm::vec3 three(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

}  // namespace

SolidRow<float> solid_row_of(const Solid& s) {
  return {three(s.center),
          three(s.start),
          three(s.velocity),
          three(s.spin),
          three(s.half),
          {three(s.axes[0]), three(s.axes[1]), three(s.axes[2])},
          {three(s.start_axes[0]), three(s.start_axes[1]), three(s.start_axes[2])},
          s.reach,
          s.deep,
          s.friction};
}

bool sweep_touches_bodies(const Plan& plan) {
  return plan.reaching.bodies && std::ranges::any_of(plan.steps, [](const PlanStep& step) {
           return (step.pass == &integrate || step.pass == &xpbd_finish) &&
                  step.block == weft::Block::substep;
         });
}

BodyTouch::BodyTouch(const Model& model, std::size_t stride)
    : stride_(stride), solid_count_(solid_count(model)), meshes_(model.meshes), ground_(model) {}

void BodyTouch::touch_rest(const void* self, const Kick& kick, const Drifted* list, std::size_t count) {
  const auto& own = *static_cast<const BodyTouch*>(self);
  for (std::size_t k = 0; k < count; ++k) own.touch(kick, list[k]);
}

void BodyTouch::touch(const Kick& kick, const Drifted& drifted) const {
  const auto vector_at = [&](std::size_t first) {
    const float* const at = drifted.at + first * stride_;
    return glm::vec3(at[0], at[stride_], at[2 * stride_]);
  };
  const glm::vec3 x0 = three(drifted.from);
  glm::vec3 x1 = vector_at(0), v = vector_at(3);
  if (drifted.deep != 0) {
    for (std::uint32_t s = 0; s < solid_count_; ++s) solid_touch(solid_row_of(kick.solids[s]), x0, x1, v);
    ground_.touch(x1, v);
  }
  for (std::size_t m = 0; m < meshes_.size(); ++m)
    touch_mesh(*meshes_[m], solid_row_of(kick.meshes[m]), x0, x1, v);
  if (!meshes_.empty()) ground_.touch(x1, v);
  for (int axis = 0; axis < 3; ++axis) {
    drifted.at[axis * stride_] = x1[axis];
    drifted.at[(3 + axis) * stride_] = v[axis];
  }
}

}  // namespace weft::native
