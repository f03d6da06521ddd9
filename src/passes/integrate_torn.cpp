// integrate_torn: one substep of a cloth of which links are broken, gathered particle by particle; until then
// `integrate` moves it. Declaration and CPU mirror. docs/float-form.md "Tearing": integrate's sum without
// what is broken.
#include "passes/passes.h"
#include "passes/reach.h"
#include "passes/tearing.h"

namespace weft {
namespace {

/// The force on the first particle of a pair; docs/float-form.md "One pair".
template <class T>
Vec3<T> pair_force(const glm::vec<4, T>& row, bool damped, const Particle<T>& a, const Particle<T>& b) {
  const Vec3<T> d = b.x - a.x;
  const T q = std::max(dot3(d, d), static_cast<T>(1e-24)), r = T(1) / std::sqrt(q);
  if (!damped) return (row.x - row.y * r) * d;
  return (((row.z * dot3(d, b.v - a.v)) * r - row.y) * r + row.x) * d;
}

/// The force on one particle.
template <class T>
class Gather {
 public:
  Gather(const MirrorContext& context, const HostBuffers<T>& buffers, const Substep<T>& substep)
      : grid_(context.model.grid),
        rows_(spring_rows<T>(context.model)),
        effects_(force_effects(context.constants)),
        buffers_(buffers),
        substep_(substep),
        links_(buffers.words_of(BufferId::broken_links)) {}

  Vec3<T> at(std::uint32_t i, std::uint32_t j) const {
    const std::uint32_t p = grid_.index(i, j);
    const Line along_i = line(p, i, grid_.nx, 1, shared::kLinkAlongI);
    const Line along_j = line(p, j, grid_.ny, grid_.nx, shared::kLinkAlongJ);
    const std::size_t row_edge = edge(j, grid_.ny), column_edge = edge(i, grid_.nx);
    const bool left = i >= 1, right = i + 1 < grid_.nx, up = j >= 1, down = j + 1 < grid_.ny;
    const std::uint32_t nx = grid_.nx;
    const auto near = [&](const Line& at_line, std::size_t row, int which, std::uint32_t step) {
      const std::uint32_t a = which == 0 ? p : p - step;
      return at_line.whole[which + 2] ? force(rows_.structural[row * 3 + at_line.triples(which)], a, a + step)
                                      : Vec3<T>(T(0));
    };
    const auto far = [&](const Line& at_line, std::size_t row, int which, std::uint32_t step) {
      const bool whole = effects_.two_apart && at_line.whole[which + 2] && at_line.whole[which + 3];
      const std::uint32_t a = which == 0 ? p : p - 2 * step;
      return whole ? force(rows_.flex[row], a, a + 2 * step) : Vec3<T>(T(0));
    };
    const auto shear = [&](bool exists, std::uint32_t named, std::uint32_t bit, std::uint32_t a,
                           std::uint32_t b) {
      const bool whole = exists && effects_.shear && !is_broken(links_, named, bit);
      return whole ? force(rows_.shear, a, b) : Vec3<T>(T(0));
    };
    using shared::kLinkFalling, shared::kLinkRising;
    const Vec3<T> above = ((far(along_j, 2 + column_edge, -2, nx) + near(along_j, 2 + column_edge, -1, nx)) +
                           shear(up && right, p - nx, kLinkRising, p - nx + 1, p)) +
                          shear(up && left, p - nx - 1, kLinkFalling, p - nx - 1, p);
    const Vec3<T> back =
        shear(down && left, p - 1, kLinkRising, p, p + nx - 1) - near(along_i, row_edge, -1, 1);
    return ((((((near(along_j, 2 + column_edge, 0, nx) - above) + near(along_i, row_edge, 0, 1)) + back) +
              shear(down && right, p, kLinkFalling, p, p + nx + 1)) +
             far(along_i, row_edge, 0, 1)) -
            far(along_i, row_edge, -2, 1)) +
           far(along_j, 2 + column_edge, 0, nx);
  }

 private:
  /// The four near links of a line around a particle: from two before it to one after it.
  struct Line {
    bool whole[4];
    /// How many whole triples have the link as neighbours; which: 0 after the particle, -1 before it.
    std::size_t triples(int which) const {
      const int k = which + 2;
      return (whole[k - 1] ? 1u : 0u) + (k + 1 < 4 && whole[k + 1] ? 1u : 0u);
    }
  };
  static std::size_t edge(std::uint32_t place, std::uint32_t count) {
    return place == 0 || place + 1 == count ? 1 : 0;
  }
  Line line(std::uint32_t p, std::uint32_t place, std::uint32_t count, std::uint32_t step,
            std::uint32_t bit) const {
    const auto whole = [&](bool exists, std::uint32_t first) {
      return exists && !is_broken(links_, first, bit);
    };
    return {{whole(place >= 2, p - 2 * step), whole(place >= 1, p - step), whole(place + 1 < count, p),
             whole(place + 2 < count, p + step)}};
  }
  Vec3<T> force(const glm::vec<4, T>& row, std::uint32_t a, std::uint32_t b) const {
    return pair_force(row, effects_.damping, Particle<T>(buffers_, substep_, a),
                      Particle<T>(buffers_, substep_, b));
  }

  const Grid& grid_;
  SpringRows<T> rows_;
  ForceEffects effects_;
  const HostBuffers<T>& buffers_;
  const Substep<T>& substep_;
  const std::vector<std::uint32_t>& links_;
};

template <class T, bool kCompensated>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  if (!is_torn(context.model, buffers)) return;
  const Grid& grid = context.model.grid;
  const Substep<T> substep(context);
  auto& position_next = buffers[BufferId::position_next];
  auto& velocity_next = buffers[BufferId::velocity_next];
  position_next.resize(grid.count());
  velocity_next.resize(grid.count());
  ReachTeller<T> reach(context, buffers);
  reach.look_at_torn();
  Compensation<T, kCompensated> compensation(buffers, grid.count());
  const Gather<T> gather(context, buffers, substep);
  parallel_rows(grid.ny, grid.nx, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t p = begin * grid.nx; p < end * grid.nx; ++p) {
      const Particle<T> own(buffers, substep, p);
      Vec3<T> x1 = own.x, v = own.v;
      if (!own.pinned()) {
        const Vec3<T> force = gather.at(p % grid.nx, p / grid.nx);
        kick_drift_touch(substep, compensation, p, substep.acceleration(force, own.w), own.x, x1, v);
        reach.look(own.x, x1);
      }
      position_next[p] = glm::vec<4, T>(x1, own.relative);
      velocity_next[p] = glm::vec<4, T>(v, T(0));
    }
  });
}

}  // namespace

const Pass integrate_torn{
    .name = "integrate_torn",
    .about = "springs that are whole, damping, bending, air, gravity, contact: one kick and drift",
    .domain = whole_cloth,
    .constants = integrate_constants,
    .mirror_f32 = mirror<float, false>,
    .mirror_f64 = mirror<double, false>,
    .compensated = &integrate_torn_compensated,
    .reach_word = [](std::uint32_t) { return shared::kReachTorn; },
    .tells_reach = true,
    .sees_links = true,
};

const Pass integrate_torn_compensated{
    .name = "integrate_torn_compensated",
    .about =
        "springs that are whole, damping, bending, air, gravity, contact: one kick and drift, positions "
        "summed "
        "with compensation",
    .domain = whole_cloth,
    .constants = integrate_constants,
    .mirror_f32 = mirror<float, true>,
    .mirror_f64 = mirror<double, true>,
    .reach_word = [](std::uint32_t) { return shared::kReachTorn; },
    .tells_reach = true,
    .sees_links = true,
};

}  // namespace weft
