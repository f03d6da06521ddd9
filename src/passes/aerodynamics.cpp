// aerodynamics, and aerodynamics_torn where links break: drag and lift of the whole triangles around each
// particle, as a kick that cannot overshoot. Declarations and CPU mirror. Source: Wejchert and Haumann 1991,
// Animation aerodynamics.
#include <array>

#include "passes/passes.h"
#include "passes/solid.h"
#include "passes/tearing.h"
#include "passes/wind_noise.h"

namespace weft {
namespace {

Range domain(const Model& m) { return m.scene.aerodynamics ? whole_cloth(m) : Range{}; }

Constants constants(const Model& m) {
  const bool noise = has_wind_noise(m.scene);
  return {{"air rows", row_layout(m).air}, {"noise", noise}, {"seed", noise ? m.scene.wind->seed : 0}};
}

/// A sum over triangles.
template <class T>
struct AirSum {
  Vec3<T> force{T(0)};  ///< [N]
  T rate = T(0);        ///< force over speed that bounds it [kg/s]
};

template <class T>
class AirForce {
 public:
  AirForce(const HostBuffers<T>& buffers, const Grid& grid, const AirRow<T>& air,
           std::span<const std::uint32_t> links)
      : x_(buffers[BufferId::position]),
        v_(buffers[BufferId::velocity]),
        grid_(grid),
        air_(air),
        links_(links) {}

  /// Of the triangles around (i, j), in the order of docs/float-form.md "Vertex normals".
  AirSum<T> at(std::uint32_t i, std::uint32_t j, const Vec3<T>& wind) const {
    // A(i,j), B(i−1,j), A(i−1,j), B(i,j−1), A(i,j−1), B(i−1,j−1): cell and corners by offset.
    struct Triangle {
      int cell_i, cell_j;
      bool second;
    };
    constexpr std::array<Triangle, 6> kAround{
        {{0, 0, false}, {-1, 0, true}, {-1, 0, false}, {0, -1, true}, {0, -1, false}, {-1, -1, true}}};
    AirSum<T> sum;
    for (const Triangle& triangle : kAround) {
      const int ci = int(i) + triangle.cell_i, cj = int(grid_.own_row(j)) + triangle.cell_j;
      if (ci < 0 || cj < 0 || ci + 1 >= int(grid_.nx) || cj + 1 >= int(grid_.ny)) continue;
      const std::uint32_t a = grid_.index(std::uint32_t(ci), j + std::uint32_t(triangle.cell_j)),
                          below = a + grid_.nx;
      if (!(triangle.second ? is_whole_b(links_, grid_, a) : is_whole_a(links_, a))) continue;
      if (triangle.second)
        add(a + 1, below, below + 1, wind, sum);
      else
        add(a, below, a + 1, wind, sum);
    }
    return sum;
  }

 private:
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c, const Vec3<T>& wind, AirSum<T>& sum) const {
    const Vec3<T> n = cross3(xyz(x_[b]) - xyz(x_[a]), xyz(x_[c]) - xyz(x_[a]));
    const Vec3<T> u = wind - ((xyz(v_[a]) + xyz(v_[b])) + xyz(v_[c])) / T(3);
    const T area2 = std::sqrt(dot3(n, n)), speed = std::sqrt(dot3(u, u));
    if (!(area2 > static_cast<T>(shared::kNoNormal)) || !(speed > static_cast<T>(shared::kNoLength))) return;
    const T through = dot3(u, n), normal_speed = through / area2;
    const T along = air_.drag * std::abs(through) - air_.lift * ((through * normal_speed) / speed);
    const T across = (air_.lift * speed) * normal_speed;
    sum.force = sum.force + (along * u + across * n);
    sum.rate = sum.rate + ((air_.drag + air_.lift) * speed) * area2;
  }

  const std::vector<glm::vec<4, T>>&x_, &v_;
  const Grid& grid_;
  const AirRow<T>& air_;
  std::span<const std::uint32_t> links_;
};

template <class T, bool kTorn>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const Substep<T> substep(context);
  const Grid& grid = context.model.grid;
  const AirRow<T> air = air_row<T>(context.model, context.row);
  const bool noisy = has_wind_noise(context.model.scene);
  auto& position_next = buffers[BufferId::position_next];
  auto& velocity_next = buffers[BufferId::velocity_next];
  position_next.resize(grid.count());
  velocity_next.resize(grid.count());
  const AirForce<T> force(buffers, grid, air, links_of<kTorn>(buffers));
  parallel_rows(grid.rows(), grid.nx, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t p = begin * grid.nx; p < end * grid.nx; ++p) {
      const Particle<T> own(buffers, substep, p);
      Vec3<T> v = own.v;
      if (own.relative != T(0)) {
        Vec3<T> wind = air.wind;
        if (noisy) wind = wind + air.noise_m_s * wind_noise(air, own.x, context.model.scene.wind->seed);
        const AirSum<T> sum = force.at(p % grid.nx, p / grid.nx, wind);
        const T gain = substep.row.gain;
        v = v + (gain * (sum.force * own.w)) / (T(1) + gain * (sum.rate * own.w));
      }
      position_next[p] = glm::vec<4, T>(own.x, own.relative);
      velocity_next[p] = glm::vec<4, T>(v, T(0));
    }
  });
}

}  // namespace

const Pass aerodynamics{
    .name = "aerodynamics",
    .about = "drag and lift of the triangles, quadratic in the speed of the air",
    .domain = domain,
    .constants = constants,
    .mirror_f32 = mirror<float, false>,
    .mirror_f64 = mirror<double, false>,
    .swaps_state = true,
    .torn = &aerodynamics_torn,
};

const Pass aerodynamics_torn{
    .name = "aerodynamics_torn",
    .about = "drag and lift of the triangles that are whole, quadratic in the speed of the air",
    .domain = domain,
    .constants = constants,
    .mirror_f32 = mirror<float, true>,
    .mirror_f64 = mirror<double, true>,
    .swaps_state = true,
};

}  // namespace weft
