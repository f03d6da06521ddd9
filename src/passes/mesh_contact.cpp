// mesh_contact: meshes push out what a drift brought into them, by distances on grids. Declaration and CPU
// mirror.
#include <array>
#include <bit>

#include "model/distance_grid.h"
#include "passes/ground.h"
#include "passes/mesh_grids.h"
#include "passes/passes.h"
#include "passes/reach.h"
#include "passes/substep.h"

namespace weft {
namespace {

Range domain(const Model& m) { return m.meshes.empty() ? Range{} : whole_cloth(m); }

Constants constants(const Model& m) {
  const RowLayout at = row_layout(m);
  const bool tilted = has_tilted_floor(m);
  return {{"meshes", static_cast<std::uint32_t>(m.meshes.size())},
          {"mesh rows", at.meshes},
          {"floor", m.scene.floor && !tilted},
          {"tilted floor", tilted ? at.floor : 0}};
}

/// A grid in T with the surface half a thickness outside.
template <class T>
class MeshField {
 public:
  MeshField(const DistanceGrid& grid, T reach)
      : grid_(grid),
        low_(grid.low_m),
        last_(grid.samples - 1u),
        cell_(static_cast<T>(grid.cell_m)),
        reach_(reach) {}

  T cell() const { return cell_; }
  const Vec3<T>& low() const { return low_; }
  Vec3<T> high() const { return low_ + last_ * cell_; }

  bool holds(const Vec3<T>& p) const {
    for (int k = 0; k < 3; ++k) {
      const T q = (p[k] - low_[k]) / cell_;
      if (!(q >= T(0) && q <= last_[k])) return false;
    }
    return true;
  }

  SolidNear<T> near(const Vec3<T>& p) const {
    Vec3<T> t;
    std::array<std::size_t, 3> at;
    for (int k = 0; k < 3; ++k) {
      const T q = std::min(std::max((p[k] - low_[k]) / cell_, T(0)), last_[k]);
      const T low = std::min(std::floor(q), last_[k] - T(1));
      t[k] = q - low;
      at[std::size_t(k)] = static_cast<std::size_t>(low);
    }
    T x[2][2], e[2][2], y[2], f[2];
    for (std::size_t dz = 0; dz < 2; ++dz) {
      for (std::size_t dy = 0; dy < 2; ++dy) {
        const std::size_t k = ((at[2] + dz) * grid_.samples.y + at[1] + dy) * grid_.samples.x + at[0];
        const T a = T(grid_.distance[k]);
        x[dz][dy] = T(grid_.distance[k + 1]) - a;
        e[dz][dy] = a + t.x * x[dz][dy];
      }
      y[dz] = e[dz][1] - e[dz][0];
      f[dz] = e[dz][0] + t.y * y[dz];
    }
    const T z = f[1] - f[0], distance = f[0] + t.z * z;
    const T x0 = x[0][0] + t.y * (x[0][1] - x[0][0]), x1 = x[1][0] + t.y * (x[1][1] - x[1][0]);
    const Vec3<T> slope(x0 + t.z * (x1 - x0), y[0] + t.z * (y[1] - y[0]), z);
    const T l = std::sqrt(dot3(slope, slope));
    const Vec3<T> up(T(0), T(1), T(0));
    return {distance - reach_, l > static_cast<T>(shared::kNoLength) ? slope * (T(1) / l) : up};
  }

 private:
  const DistanceGrid& grid_;
  Vec3<T> low_, last_;
  T cell_, reach_;
};

/// The part of p0 + t·way, t in [from, to], that lies in the grid's box; false when none does.
template <class T>
bool clip_to_grid(const MeshField<T>& field, const Vec3<T>& p0, const Vec3<T>& way, T& from, T& to) {
  const Vec3<T> high = field.high();
  for (int k = 0; k < 3; ++k) {
    if (way[k] == T(0)) {
      if (p0[k] < field.low()[k] || p0[k] > high[k]) return false;
      continue;
    }
    const T a = (field.low()[k] - p0[k]) / way[k], b = (high[k] - p0[k]) / way[k];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  return from <= to;
}

template <class T>
T bisected_entry(const MeshField<T>& field, const Vec3<T>& p0, const Vec3<T>& way, T outside, T inside) {
  for (std::uint32_t k = 0; k < shared::kMeshBisections; ++k) {
    const T middle = T(0.5) * (outside + inside);
    (field.near(p0 + middle * way).distance > T(0) ? outside : inside) = middle;
  }
  return outside;
}

/// Where the path came in from outside, when it went deep.
template <class T>
bool enters_mesh(const MeshField<T>& field, T deep, const Vec3<T>& p0, const Vec3<T>& way, T& entry) {
  T from = T(0), to = T(1);
  if (!clip_to_grid(field, p0, way, from, to)) return false;
  const T speed = std::sqrt(dot3(way, way)), half_cell = T(0.5) * field.cell();
  T outside = from, t = from;
  for (std::uint32_t k = 0; k < shared::kMeshMarchSteps; ++k) {
    const T distance = field.near(p0 + t * way).distance;
    if (distance < -deep) {
      if (k == 0) return false;
      entry = bisected_entry(field, p0, way, outside, t);
      return true;
    }
    if (t >= to) return false;
    outside = t;
    t = std::min(t + std::max(distance, half_cell) / speed, to);
  }
  return false;
}

/// Puts x1 where `point` comes to on the surface, and takes the approach from v.
/// @return the surface there, in the body's frame, at distance 0
template <class T>
Vec3<T> mesh_respond(const MeshField<T>& field, const SolidRow<T>& row, const Vec3<T>& point, Vec3<T>& x1,
                     Vec3<T>& v, Vec3<T>& normal) {
  Vec3<T> p = point;
  SolidNear<T> near = field.near(p);
  for (std::uint32_t k = 0; k < shared::kMeshProjections; ++k) {
    p = p - near.distance * near.normal;
    near = field.near(p);
  }
  const Vec3<T> surface = p - near.distance * near.normal, arm = in_world(row.axes, surface);
  x1 = row.center + arm;
  v = respond(v, row.velocity + cross3(row.spin, arm), in_world(row.axes, near.normal), row.friction);
  normal = near.normal;
  return surface;
}

/// A path that goes deep is turned aside where it enters, and followed once more from there along the tangent
/// plane; a second time it ends where it enters.
template <class T>
void mesh_touch(const MeshField<T>& field, const SolidRow<T>& row, const Vec3<T>& x0, Vec3<T>& x1,
                Vec3<T>& v) {
  Vec3<T> from = in_frame(row.start_axes, x0 - row.start), to = in_frame(row.axes, x1 - row.center), normal;
  const T half_cell = T(0.5) * field.cell();
  for (int turn = 0; turn < 2; ++turn) {
    const Vec3<T> way = to - from;
    T entry = T(0);
    const bool entered =
        dot3(way, way) > half_cell * half_cell && enters_mesh(field, row.deep, from, way, entry);
    if (!entered) {
      if (field.holds(to) && field.near(to).distance < T(0)) mesh_respond(field, row, to, x1, v, normal);
      return;
    }
    from = mesh_respond(field, row, from + entry * way, x1, v, normal);
    if (turn == 1) return;
    to = to - std::min(dot3(to - from, normal), T(0)) * normal;
    x1 = row.center + in_world(row.axes, to);
  }
}

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  if (!take_reach(context.model, buffers, shared::kReachMeshes)) return;
  const SubstepRow<T> row = substep_row<T>(context.model, context.row);
  const Ground<T> ground(context.model);
  const Grid& grid = context.model.grid;
  std::vector<MeshField<T>> fields;
  for (std::size_t m = 0; m < row.meshes.size(); ++m)
    fields.emplace_back(*context.model.meshes[m], row.meshes[m].reach);
  auto& position = buffers[BufferId::position];
  auto& velocity = buffers[BufferId::velocity];
  const auto& before = std::as_const(buffers)[BufferId::position_next];
  parallel_rows(grid.rows(), grid.nx, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t p = begin * grid.nx; p < end * grid.nx; ++p) {
      if (position[p].w == T(0)) continue;
      Vec3<T> x1 = xyz(position[p]), v = xyz(velocity[p]);
      for (std::size_t m = 0; m < fields.size(); ++m)
        mesh_touch(fields[m], row.meshes[m], xyz(before[p]), x1, v);
      ground.touch(x1, v);
      position[p] = glm::vec<4, T>(x1, position[p].w);
      velocity[p] = glm::vec<4, T>(v, T(0));
    }
  });
}

}  // namespace

std::vector<std::uint32_t> make_distance_words(const Model& model) {
  std::vector<std::uint32_t> words;
  for (const auto& grid : model.meshes)
    for (const float distance : grid->distance) words.push_back(std::bit_cast<std::uint32_t>(distance));
  return words;
}

std::uint64_t distance_word_count(const Model& model) {
  std::uint64_t count = 0;
  for (const auto& grid : model.meshes) count += grid->distance.size();
  return count;
}

void touch_mesh(const DistanceGrid& grid, const SolidRow<float>& row, const glm::vec3& x0, glm::vec3& x1,
                glm::vec3& v) {
  mesh_touch(MeshField<float>(grid, row.reach), row, x0, x1, v);
}

const Pass mesh_contact{
    .name = "mesh_contact",
    .about = "contact with meshes, then the floor again",
    .domain = domain,
    .constants = constants,
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
    .reach_word = [](std::uint32_t) { return shared::kReachMeshes; },
};

}  // namespace weft
