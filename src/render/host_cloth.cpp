// Positions and normals from the host into vertex buffers.
#include "render/host_cloth.h"

#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "core/error.h"
#include "model/state_io.h"
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

HostCloth::HostCloth(gpu::Device& device, const Grid& grid)
    : device_(device),
      grid_(grid),
      position_(vertex_buffer(device, "host position", grid)),
      normal_(vertex_buffer(device, "host normal", grid)) {}

void HostCloth::upload(const State& state) {
  WEFT_ASSERT(state.position.size() == grid_.count());
  std::vector<glm::vec4> positions;
  positions.reserve(state.position.size());
  for (const glm::dvec3& p : state.position) positions.emplace_back(p, 1.0);
  position_.write(std::as_bytes(std::span(positions)));
  std::vector<glm::vec4> normals;
  normals.reserve(state.position.size());
  for (const glm::dvec3& n : vertex_normals(grid_, state)) normals.emplace_back(n, 0.0);
  normal_.write(std::as_bytes(std::span(normals)));
  if (state.broken_links.empty()) return;
  const std::vector<std::uint32_t> mesh = torn_indices(grid_, state.broken_links);
  if (!torn_mesh_)
    torn_mesh_ =
        gpu::Buffer(device_, "host torn mesh", mesh.size() * sizeof(std::uint32_t),
                    VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Memory::device);
  torn_mesh_.write(std::as_bytes(std::span(mesh)));
}

}  // namespace weft
