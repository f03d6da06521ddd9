// normals, and normals_torn where links break: vertex normals from the adjacent triangles that are whole.
// Declarations and CPU mirror.
#include <cmath>

#include "passes/passes.h"
#include "passes/tearing.h"

namespace weft {
namespace {

/// Unnormalised normal of the triangle (p, q, r): (q - p) x (r - p), each component product minus product.
template <class T>
Vec3<T> triangle(const glm::vec<4, T>& p, const glm::vec<4, T>& q, const glm::vec<4, T>& r) {
  const T ax = q.x - p.x, ay = q.y - p.y, az = q.z - p.z;
  const T bx = r.x - p.x, by = r.y - p.y, bz = r.z - p.z;
  return {ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx};
}

/// Adds the triangles around vertex (i, j) in the order of docs/float-form.md "Vertex normals".
template <class T>
Vec3<T> whole_sum(const Grid& grid, const std::vector<glm::vec<4, T>>& x,
                  std::span<const std::uint32_t> links, std::uint32_t i, std::uint32_t j) {
  Vec3<T> sum(T(0));
  const auto add_a = [&](std::uint32_t cell) {
    if (is_whole_a(links, cell)) sum = sum + triangle(x[cell], x[cell + grid.nx], x[cell + 1]);
  };
  const auto add_b = [&](std::uint32_t cell) {
    if (is_whole_b(links, grid, cell))
      sum = sum + triangle(x[cell + 1], x[cell + grid.nx], x[cell + grid.nx + 1]);
  };
  const std::uint32_t own = grid.index(i, j);
  const bool left = i > 0, right = i + 1 < grid.nx, above = grid.own_row(j) > 0,
             below = grid.own_row(j) + 1 < grid.ny;
  if (right && below) add_a(own);
  if (left && below) add_b(own - 1), add_a(own - 1);
  if (right && above) add_b(own - grid.nx), add_a(own - grid.nx);
  if (left && above) add_b(own - grid.nx - 1);
  return sum;
}

template <class T, bool kTorn>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const Grid& grid = context.model.grid;
  const std::span<const std::uint32_t> links = links_of<kTorn>(buffers);
  auto& normal = buffers[BufferId::normal];
  normal.resize(grid.count());
  parallel_rows(grid.rows(), grid.nx, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t j = begin; j < end; ++j)
      for (std::uint32_t i = 0; i < grid.nx; ++i) {
        const Vec3<T> n = whole_sum(grid, buffers[BufferId::position], links, i, j);
        const T l = std::sqrt(dot3(n, n));
        normal[grid.index(i, j)] =
            glm::vec<4, T>(l > static_cast<T>(shared::kNoNormal) ? n * (T(1) / l) : Vec3<T>(T(0)), T(0));
      }
  });
}

}  // namespace

const Pass normals{
    .name = "normals",
    .about = "vertex normals: the adjacent triangles' normals, averaged",
    .domain = whole_cloth,
    .mirror_f32 = mirror<float, false>,
    .mirror_f64 = mirror<double, false>,
    .torn = &normals_torn,
};

const Pass normals_torn{
    .name = "normals_torn",
    .about = "vertex normals: the normals of the adjacent triangles that are whole, averaged",
    .domain = whole_cloth,
    .mirror_f32 = mirror<float, true>,
    .mirror_f64 = mirror<double, true>,
};

}  // namespace weft
