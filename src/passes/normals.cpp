// normals: vertex normals from the adjacent triangles. Declaration and CPU mirror.
#include <cmath>

#include "passes/parallel.h"
#include "passes/passes.h"

namespace weft {
namespace {

/// Unnormalised normal of the triangle (p, q, r): (q − p) × (r − p), each component product minus product.
template <class T>
glm::vec<3, T> triangle(const glm::vec<4, T>& p, const glm::vec<4, T>& q, const glm::vec<4, T>& r) {
  const T ax = q.x - p.x, ay = q.y - p.y, az = q.z - p.z;
  const T bx = r.x - p.x, by = r.y - p.y, bz = r.z - p.z;
  return {ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx};
}

/// Sum over the adjacent triangles of vertex (i, j), in the order of docs/float-form.md "Vertex normals".
/// Cell (i, j) has the triangles A = (i,j) (i,j+1) (i+1,j) and B = (i+1,j) (i,j+1) (i+1,j+1).
template <class T>
glm::vec<3, T> normal_sum(const Grid& grid, const std::vector<glm::vec<4, T>>& position, std::uint32_t i,
                          std::uint32_t j) {
  const auto at = [&](std::uint32_t column, std::uint32_t row) { return position[grid.index(column, row)]; };
  const auto a = [&](std::uint32_t ci, std::uint32_t cj) {
    return triangle(at(ci, cj), at(ci, cj + 1), at(ci + 1, cj));
  };
  const auto b = [&](std::uint32_t ci, std::uint32_t cj) {
    return triangle(at(ci + 1, cj), at(ci, cj + 1), at(ci + 1, cj + 1));
  };
  const bool left = i > 0, right = i + 1 < grid.nx, above = j > 0, below = j + 1 < grid.ny;
  glm::vec<3, T> sum(T(0));
  if (right && below) sum = sum + a(i, j);
  if (left && below) sum = (sum + b(i - 1, j)) + a(i - 1, j);
  if (right && above) sum = (sum + b(i, j - 1)) + a(i, j - 1);
  if (left && above) sum = sum + b(i - 1, j - 1);
  return sum;
}

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const Grid& grid = context.model.grid;
  const auto& position = buffers[BufferId::position];
  auto& normal = buffers[BufferId::normal];
  normal.resize(grid.count());
  parallel_rows(grid.ny, grid.nx, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t j = begin; j < end; ++j) {
      for (std::uint32_t i = 0; i < grid.nx; ++i) {
        const glm::vec<3, T> n = normal_sum(grid, position, i, j);
        const T l = std::sqrt((n.x * n.x + n.y * n.y) + n.z * n.z);
        const glm::vec<3, T> unit =
            l > static_cast<T>(shared::kNoNormal) ? n * (T(1) / l) : glm::vec<3, T>(T(0));
        normal[grid.index(i, j)] = glm::vec<4, T>(unit, T(0));
      }
    }
  });
}

}  // namespace

const Pass normals{
    .name = "normals",
    .about = "vertex normals: the adjacent triangles' normals, averaged",
    .domain = whole_cloth,
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
    .torn = &normals_torn,
};

}  // namespace weft
