// A pair is free once everything that was submitted while it was shown is finished.
#include "sim/draw_pairs.h"

#include <algorithm>
#include <span>

#include "passes/tearing.h"

namespace weft {
namespace {

gpu::Buffer drawn_buffer(gpu::Device& device, const char* name, std::uint64_t bytes,
                         VkBufferUsageFlags usage) {
  return gpu::Buffer(device, name, bytes,
                     usage | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                     gpu::Memory::upload);
}

template <class Element>
void* place_of(const gpu::Buffer& buffer, std::vector<Element>& staged) {
  if (buffer.mapped() != nullptr) return buffer.mapped();
  staged.resize(buffer.bytes() / sizeof(Element));
  return staged.data();
}

}  // namespace

DrawPairs::DrawPairs(gpu::Device& device, const Model& model) : device_(device) {
  const std::uint64_t bytes = model.grid.count() * sizeof(glm::vec4);
  for (Pair& pair : pairs_) {
    pair.position = drawn_buffer(device, "drawn position", bytes, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    pair.normal = drawn_buffer(device, "drawn normal", bytes, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    if (model.scene.tearing)
      pair.torn_mesh =
          drawn_buffer(device, "drawn torn mesh", torn_mesh_words(model.grid) * sizeof(std::uint32_t),
                       VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
  }
}

DrawPairs::~DrawPairs() {
  try {
    device_.wait(device_.submitted());
  } catch (...) {  // a lost device has nothing left to wait for
  }
}

DrawPairs::Taken DrawPairs::take() {
  std::size_t best = pairs_.size();
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    if (p == shown_ || pairs_[p].taken) continue;
    if (best == pairs_.size() || pairs_[p].read_until < pairs_[best].read_until) best = p;
  }
  Pair& pair = pairs_.at(best);
  if (pair.read_until > device_.completed()) device_.wait(pair.read_until);
  pair.taken = true;
  Taken taken{best,
              {static_cast<float*>(place_of(pair.position, pair.staged_position)),
               static_cast<float*>(place_of(pair.normal, pair.staged_normal))}};
  if (pair.torn_mesh)
    taken.surface.torn_mesh = static_cast<std::uint32_t*>(place_of(pair.torn_mesh, pair.staged_mesh));
  return taken;
}

void DrawPairs::show(const Taken& taken) {
  Pair& before = pairs_[shown_];
  const std::uint64_t now = device_.submitted();
  if (now != before.shown_since) before.read_until = now;  // else no picture was made of it
  Pair& next = pairs_[taken.pair];
  if (next.position.mapped() == nullptr) {
    next.position.write(std::as_bytes(std::span(next.staged_position)));
    next.normal.write(std::as_bytes(std::span(next.staged_normal)));
  }
  if (next.torn_mesh && next.torn_mesh.mapped() == nullptr)
    next.torn_mesh.write(std::as_bytes(std::span(next.staged_mesh)));
  next.shown_since = device_.submitted();
  next.taken = false;
  shown_ = taken.pair;
}

std::uint64_t DrawPairs::bytes() const {
  std::uint64_t bytes = 0;
  for (const Pair& pair : pairs_) {
    bytes += pair.position.bytes() + pair.normal.bytes();
    if (pair.torn_mesh) bytes += pair.torn_mesh.bytes();
  }
  return bytes;
}

}  // namespace weft
