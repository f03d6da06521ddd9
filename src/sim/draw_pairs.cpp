// A pair is free once everything that was submitted while it was shown is finished.
#include "sim/draw_pairs.h"

#include <algorithm>
#include <span>

namespace weft {
namespace {

gpu::Buffer drawn_buffer(gpu::Device& device, const char* name, std::uint64_t particles) {
  constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_VERTEX_BUFFER_BIT |
                                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  return gpu::Buffer(device, name, particles * sizeof(glm::vec4), kUsage, gpu::Memory::upload);
}

float* place_of(const gpu::Buffer& buffer, std::vector<glm::vec4>& staged) {
  if (buffer.mapped() != nullptr) return reinterpret_cast<float*>(buffer.mapped());
  staged.resize(buffer.bytes() / sizeof(glm::vec4));
  return &staged.data()->x;
}

}  // namespace

DrawPairs::DrawPairs(gpu::Device& device, std::uint64_t particles) : device_(device) {
  for (Pair& pair : pairs_) {
    pair.position = drawn_buffer(device, "drawn position", particles);
    pair.normal = drawn_buffer(device, "drawn normal", particles);
  }
}

native::SurfaceTarget DrawPairs::target() {
  std::size_t best = shown_ == 0 ? 1 : 0;
  for (std::size_t p = 0; p < pairs_.size(); ++p)
    if (p != shown_ && pairs_[p].read_until < pairs_[best].read_until) best = p;
  target_ = best;
  Pair& pair = pairs_[target_];
  if (pair.read_until > device_.completed()) device_.wait(pair.read_until);
  return {place_of(pair.position, pair.staged_position), place_of(pair.normal, pair.staged_normal)};
}

void DrawPairs::show() {
  Pair& before = pairs_[shown_];
  const std::uint64_t now = device_.submitted();
  if (now != before.shown_since) before.read_until = now;  // else no picture was made of it
  Pair& next = pairs_[target_];
  if (next.position.mapped() == nullptr) {
    next.position.write(std::as_bytes(std::span(next.staged_position)));
    next.normal.write(std::as_bytes(std::span(next.staged_normal)));
  }
  next.shown_since = device_.submitted();
  shown_ = target_;
}

std::uint64_t DrawPairs::bytes() const {
  std::uint64_t bytes = 0;
  for (const Pair& pair : pairs_) bytes += pair.position.bytes() + pair.normal.bytes();
  return bytes;
}

}  // namespace weft
