// Positions and normals from the host into vertex buffers.
#include "render/host_cloth.h"

#include <glm/geometric.hpp>
#include <span>

#include "core/error.h"
#include "render/mesh.h"

namespace weft {
namespace {

gpu::Buffer vertex_buffer(gpu::Device& device, const char* name, const Grid& grid) {
  constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_VERTEX_BUFFER_BIT |
                                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  return gpu::Buffer(device, name, VkDeviceSize{grid.count()} * sizeof(glm::vec4), kUsage,
                     gpu::Memory::device);
}

}  // namespace

std::vector<glm::vec4> vertex_normals(const Grid& grid, const State& state) {
  std::vector<glm::dvec3> sum(grid.count(), glm::dvec3(0.0));
  const std::vector<std::uint32_t> triangles = cloth_triangles(grid);
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    const glm::dvec3& p = state.position[triangles[t]];
    const glm::dvec3 n =
        glm::cross(state.position[triangles[t + 1]] - p, state.position[triangles[t + 2]] - p);
    for (std::size_t corner = 0; corner < 3; ++corner) sum[triangles[t + corner]] += n;
  }
  std::vector<glm::vec4> normals;
  normals.reserve(sum.size());
  for (const glm::dvec3& n : sum) {
    const double length = glm::length(n);
    normals.emplace_back(length > 1e-30 ? n / length : glm::dvec3(0.0), 0.0);
  }
  return normals;
}

HostCloth::HostCloth(gpu::Device& device, const Grid& grid)
    : grid_(grid),
      position_(vertex_buffer(device, "host position", grid)),
      normal_(vertex_buffer(device, "host normal", grid)) {}

void HostCloth::upload(const State& state) {
  WEFT_ASSERT(state.position.size() == grid_.count());
  std::vector<glm::vec4> positions;
  positions.reserve(state.position.size());
  for (const glm::dvec3& p : state.position) positions.emplace_back(p, 1.0);
  position_.write(std::as_bytes(std::span(positions)));
  const std::vector<glm::vec4> normals = vertex_normals(grid_, state);
  normal_.write(std::as_bytes(std::span(normals)));
}

}  // namespace weft
