// xpbd_spring: one Gauss–Seidel sweep over the springs of one colour. Declaration and CPU mirror.
// Source: Macklin et al. 2016, XPBD, eq. 18 with the damping of eq. 26; λ starts at zero in every substep,
// since there is one iteration (Macklin et al. 2019, Small Steps, sect. 4).
#include "model/springs.h"
#include "passes/passes.h"
#include "passes/xpbd.h"

namespace weft {

ConstraintRows<double> constraint_rows_exact(const Model& model) {
  ConstraintRows<double> rows{};
  const auto spring = [&](SpringName name, double weight) {
    const SpringKind& kind = model.springs[name];
    if (kind.stiffness_n_m <= 0.0) return glm::dvec4(0.0);
    return glm::dvec4(kind.rest_m, 1.0 / (weight * kind.stiffness_n_m),
                      kind.damping_n_s_m / kind.stiffness_n_m, 0.0);
  };
  for (std::uint32_t along = 0; along < 2; ++along) {
    const std::uint32_t from = along * shared::kConstraintRows;
    const SpringName structural = along == 0 ? kStructuralI : kStructuralJ,
                     flex = along == 0 ? kFlexI : kFlexJ;
    rows[from + shared::kConstraintStructural] = spring(structural, 1.0);
    rows[from + shared::kConstraintStructural + 1] = spring(structural, 0.5);
    rows[from + shared::kConstraintShear] = spring(kShearDown, 1.0);
    rows[from + shared::kConstraintFlex] = spring(flex, 1.0);
    rows[from + shared::kConstraintFlex + 1] = spring(flex, 0.5);
    if (model.bend_kappa_n_m[along] > 0.0) {
      rows[from + shared::kConstraintBend].y = 1.0 / model.bend_kappa_n_m[along];
      rows[from + shared::kConstraintBend + 1].y = 2.0 / model.bend_kappa_n_m[along];
    }
  }
  return rows;
}

namespace {

Constants constants(const Model& m) {
  Constants all{integrate_constants(m)[kHasDamping]};
  if (m.anisotropic()) all.push_back({"anisotropic", 1});
  return all;
}

/// The row of a spring's coefficients that begins at (i, j).
std::size_t row_of(const Model& model, SpringName kind, std::uint32_t i, std::uint32_t j) {
  const Grid& grid = model.grid;
  const std::size_t warp = constraint_shift(model);
  const bool on_j_edge = j == 0 || j + 1 == grid.ny, on_i_edge = i == 0 || i + 1 == grid.nx;
  switch (kind) {
    case kStructuralI: return shared::kConstraintStructural + (on_j_edge ? 1 : 0);
    case kStructuralJ: return shared::kConstraintStructural + warp + (on_i_edge ? 1 : 0);
    case kFlexI: return shared::kConstraintFlex + (on_j_edge ? 1 : 0);
    case kFlexJ: return shared::kConstraintFlex + warp + (on_i_edge ? 1 : 0);
    default: return shared::kConstraintShear;
  }
}

std::uint64_t item_spring_evaluations(const Model& m, std::uint32_t item) {
  std::uint64_t count = 0;
  for_each_spring_of(m.grid, SpringColour::of(item), 0, m.grid.rows(), [&](const ColouredSpring& spring) {
    count += m.loosest_inverse_mass(spring.a) + m.loosest_inverse_mass(spring.b) > 0.0 ? 1 : 0;
  });
  return count;
}

/// docs/solvers.md "xpbd", one spring: `start` is where its ends began the substep, a and b how far they have
/// moved since.
template <class T, bool kDamped>
void pull(const glm::vec<4, T>& spring, T step_s, T inverse_mass, const Vec3<T>& start, glm::vec<4, T>& a,
          glm::vec<4, T>& b) {
  const T wa = a.w * inverse_mass, wb = b.w * inverse_mass, w = wa + wb;
  if (w == T(0)) return;
  const T rate = T(1) / step_s, stiff = spring.y * (rate * rate);
  const Vec3<T> moved = xyz(b) - xyz(a), d = start + moved;
  const T l = std::sqrt(std::max(dot3(d, d), static_cast<T>(1e-24)));
  const Vec3<T> n = d * (T(1) / l);
  T error = l - spring.x, weight = w;
  if constexpr (kDamped) {
    const T gamma = spring.z * rate;
    error = error + gamma * dot3(n, moved);
    weight = (T(1) + gamma) * w;
  }
  const Vec3<T> push = (error / (weight + stiff)) * n;
  a = glm::vec<4, T>(xyz(a) + wa * push, a.w);
  b = glm::vec<4, T>(xyz(b) - wb * push, b.w);
}

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const Model& model = context.model;
  const ConstraintRows<T> rows = constraint_rows<T>(model);
  const auto& start = std::as_const(buffers)[BufferId::position];
  auto& moved = buffers[BufferId::position_next];
  const T step_s = static_cast<T>(context.row.drift_s);
  const T inverse_mass = static_cast<T>(1.0 / model.interior_mass_kg);
  const bool damped = context.constants[0].value != 0;
  const SpringColour colour = SpringColour::of(context.item);
  parallel_rows(model.grid.rows(), model.grid.nx, [&](std::uint32_t begin, std::uint32_t end) {
    for_each_spring_of(model.grid, colour, begin, end, [&](const ColouredSpring& spring) {
      const auto& row = rows[row_of(model, colour.kind, spring.i, spring.j)];
      glm::vec<4, T>&a = moved[spring.a], &b = moved[spring.b];
      const Vec3<T> d0 = xyz(start[spring.b]) - xyz(start[spring.a]);
      if (damped)
        pull<T, true>(row, step_s, inverse_mass, d0, a, b);
      else
        pull<T, false>(row, step_s, inverse_mass, d0, a, b);
    });
  });
}

}  // namespace

const Pass xpbd_spring{
    .name = "xpbd_spring",
    .about = "pulls the springs of one colour towards their rest length",
    .domain = whole_cloth,
    .constants = constants,
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
    .item_domain = spring_colour_range,
    .item_spring_evaluations = item_spring_evaluations,
};

}  // namespace weft
