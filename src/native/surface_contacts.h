// Contacts of surfaces on native: the lists of triangles and edges taken apart once for each time that they
// are made, then looked at by vectors, part by part in all threads.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "native/crew.h"
#include "native/kernel.h"
#include "passes/collision.h"

namespace weft::native {

class SurfaceContacts {
 public:
  /// All outlive this.
  SurfaceContacts(const CollisionView<float>& view, const Kernels& kernels)
      : view_(view), kernels_(kernels) {}

  /// The lists in the buffers are others than before.
  void forget_lists() { taken_apart_ = false; }
  /// surface_touch, and surface_contact after it.
  void touch(HostBuffers<float>& buffers, Crew& crew, std::uint32_t threads);
  void respond(HostBuffers<float>& buffers, Crew& crew, std::uint32_t threads);
  std::uint64_t bytes() const;

 private:
  /// Listed pairs of one kind, of some particles.
  struct Listed {
    std::vector<std::uint32_t> corners;  ///< as SurfaceLook::corners
    std::size_t count = 0;
    void add(const std::array<std::uint32_t, 4>& particles);
  };
  struct Part {
    Listed triangles, edges;
    std::vector<float> distances;
    std::vector<SurfaceTouch> touching;
    std::size_t touching_count = 0;
  };
  void take_apart(const HostBuffers<float>& buffers, std::size_t part);
  std::uint32_t look(std::size_t part, bool shared, HostBuffers<float>& buffers);
  template <class Act>
  void in_each_part(Crew& crew, std::uint32_t threads, const Act& act);

  const CollisionView<float>& view_;
  const Kernels& kernels_;
  bool taken_apart_ = false;
  std::vector<Part> parts_;
};

}  // namespace weft::native
