// strain_limit: springs of one colour that are too long are pulled back. Declaration and CPU mirror.
// Source: Provot 1995, Deformation constraints in a mass-spring model to describe rigid cloth behavior, sect.
// 4; velocities as in Mueller et al. 2007, Position based dynamics, sect. 3.1.
#include "passes/strain_limit.h"

#include "passes/passes.h"
#include "passes/reach.h"
#include "passes/spring_colours.h"
#include "passes/substep.h"

namespace weft {
namespace {

Range item_domain(const Model& m, std::uint32_t item) {
  return has_strain_limit(m) ? spring_colour_range(m, item) : Range{};
}

/// docs/float-form.md "Strain limit": one spring and its two ends.
template <class T>
void limit_spring(const glm::vec<4, T>& limit, T step_s, glm::vec<4, T>& xa, glm::vec<4, T>& xb,
                  glm::vec<4, T>& va, glm::vec<4, T>& vb) {
  const Vec3<T> d = xyz(xb) - xyz(xa);
  const T q = dot3(d, d), w = xa.w + xb.w;
  if (!(q > limit.y) || w == T(0)) return;
  const T l = std::sqrt(q);
  const Vec3<T> n = d * (T(1) / l);
  const T excess = l - limit.x;
  const Vec3<T> push = (excess / w) * n;
  const T apart = std::max(dot3(n, xyz(vb) - xyz(va)), T(0));
  const Vec3<T> kick = (std::min(excess / step_s, apart) / w) * n;
  xa = glm::vec<4, T>(xyz(xa) + xa.w * push, xa.w);
  xb = glm::vec<4, T>(xyz(xb) - xb.w * push, xb.w);
  va = glm::vec<4, T>(xyz(va) + xa.w * kick, T(0));
  vb = glm::vec<4, T>(xyz(vb) - xb.w * kick, T(0));
}

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  if (!take_links(buffers, context.item)) return;
  const Model& model = context.model;
  const SpringColour colour = SpringColour::of(context.item);
  const std::size_t row = colour.kind <= kStructuralJ ? shared::kLimitStructural : shared::kLimitShear;
  const glm::vec<4, T> limit = strain_limit_rows<T>(model)[row];
  const T step_s = static_cast<T>(context.row.drift_s);
  auto& x = buffers[BufferId::position];
  auto& v = buffers[BufferId::velocity];
  parallel_rows(model.grid.rows(), model.grid.nx, [&](std::uint32_t begin, std::uint32_t end) {
    for_each_spring_of(model.grid, colour, begin, end, [&](const ColouredSpring& s) {
      limit_spring(limit, step_s, x[s.a], x[s.b], v[s.a], v[s.b]);
    });
  });
}

}  // namespace

const Pass strain_limit{
    .name = "strain_limit",
    .about = "pulls springs of one colour back to the strain limit",
    .domain = whole_cloth,
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
    .item_domain = item_domain,
    .reach_word = reach_word_of_colour,
};

}  // namespace weft
