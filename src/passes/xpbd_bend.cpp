// xpbd_bend: one Gauss–Seidel sweep over the straight triples of one colour. Declaration and CPU mirror.
// Source: Macklin et al. 2016, XPBD, eq. 18 with the vector constraint x₋ − 2x₀ + x₊ = 0 of compliance 1/κ.
#include "passes/passes.h"
#include "passes/xpbd.h"

namespace weft {
namespace {

/// Items 0 to 2 are the triples along i that begin in columns ≡ item (mod 3); 3 to 5 those along j.
struct TripleColour {
  bool along_i;
  std::uint32_t colour;
  static TripleColour of(std::uint32_t item) { return {item < 3, item % 3}; }
};

Range item_domain(const Model& m, std::uint32_t item) {
  const TripleColour triples = TripleColour::of(item);
  const std::uint32_t length = triples.along_i ? m.grid.nx : m.grid.ny;
  if (m.bend_kappa_n_m[triples.along_i ? 0 : 1] <= 0.0 || length < triples.colour + 3) return {};
  const std::uint32_t count = (length - triples.colour) / 3;
  return triples.along_i ? Range{.x = count, .y = m.grid.rows()}
                         : Range{.x = m.grid.nx, .y = count * m.grid.cloths};
}

Constants constants(const Model& m) { return m.anisotropic() ? Constants{{"anisotropic", 1}} : Constants{}; }

template <class T>
Vec3<T> second_difference(const Vec3<T>& a, const Vec3<T>& b, const Vec3<T>& c) {
  return (a - T(2) * b) + c;
}

/// docs/solvers.md "xpbd", one triple: `start` is its second difference when the substep began; a, b and c
/// how far the particles have moved since.
template <class T>
void straighten(T compliance, T step_s, T inverse_mass, const Vec3<T>& start, glm::vec<4, T>& a,
                glm::vec<4, T>& b, glm::vec<4, T>& c) {
  const T wa = a.w * inverse_mass, wb = b.w * inverse_mass, wc = c.w * inverse_mass;
  const T w = (wa + T(4) * wb) + wc;
  if (w == T(0)) return;
  const T rate = T(1) / step_s, stiff = compliance * (rate * rate);
  const Vec3<T> xa = xyz(a), xb = xyz(b), xc = xyz(c);
  const Vec3<T> push = (start + second_difference(xa, xb, xc)) / (w + stiff);
  a = glm::vec<4, T>(xa - wa * push, a.w);
  b = glm::vec<4, T>(xb + (T(2) * wb) * push, b.w);
  c = glm::vec<4, T>(xc - wc * push, c.w);
}

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const Grid& grid = context.model.grid;
  const ConstraintRows<T> rows = constraint_rows<T>(context.model);
  const auto& start = std::as_const(buffers)[BufferId::position];
  auto& moved = buffers[BufferId::position_next];
  const T step_s = static_cast<T>(context.row.drift_s);
  const T inverse_mass = static_cast<T>(1.0 / context.model.interior_mass_kg);
  const TripleColour triples = TripleColour::of(context.item);
  const std::uint32_t di = triples.along_i ? 1 : 0, dj = 1 - di;
  parallel_rows(grid.rows(), grid.nx, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t at = begin; at < end; ++at) {
      const std::uint32_t j = grid.own_row(at);
      if (j + 2 * dj >= grid.ny) continue;
      for (std::uint32_t i = 0; i + 2 * di < grid.nx; ++i) {
        if ((triples.along_i ? i : j) % 3 != triples.colour) continue;
        const std::uint32_t line = triples.along_i ? j : i, lines = triples.along_i ? grid.ny : grid.nx;
        const std::size_t row = shared::kConstraintBend + (line == 0 || line + 1 == lines ? 1 : 0) +
                                (triples.along_i ? 0 : constraint_shift(context.model));
        const std::uint32_t a = grid.index(i, at), b = grid.index(i + di, at + dj),
                            c = grid.index(i + 2 * di, at + 2 * dj);
        straighten(rows[row].y, step_s, inverse_mass,
                   second_difference(xyz(start[a]), xyz(start[b]), xyz(start[c])), moved[a], moved[b],
                   moved[c]);
      }
    }
  });
}

}  // namespace

const Pass xpbd_bend{
    .name = "xpbd_bend",
    .about = "straightens the bending triples of one colour",
    .domain = whole_cloth,
    .constants = constants,
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
    .item_domain = item_domain,
};

}  // namespace weft
