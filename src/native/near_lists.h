// pair_gather and surface_gather on native, in one: what may be near is looked up once for all particles of a
// block that look for others, and each of them compares itself with all of it by vectors.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "native/crew.h"
#include "native/kernel.h"
#include "passes/patches.h"

namespace weft::native {

class NearLists {
 public:
  /// All outlive this.
  NearLists(const CollisionView<float>& view, const Kernels& kernels)
      : view_(view), kernels_(kernels), patches_(view.grid) {}

  /// Both passes.
  void gather(HostBuffers<float>& buffers, Crew& crew, std::uint32_t threads);
  std::uint64_t bytes() const;

 private:
  using Search = PatchSearch<float>;
  /// A block that may be near.
  struct Member {
    std::uint32_t block;
    Search::Cell cell;
  };
  struct Looker {
    std::uint32_t particle, looks;  ///< the word of its patch in patch_listed
  };
  /// What one thread needs: who looks, and the points that may be near them.
  struct Scratch {
    std::vector<Looker> lookers;
    std::vector<Member> members;
    std::vector<float> points;          ///< as NearPoints::points
    std::vector<std::uint32_t> places;  ///< by point
    std::vector<std::uint32_t> from;    ///< by point: twice its member's place, and kBoxless
    std::vector<std::uint32_t> found;
    std::uint32_t dropped = 0, listed = 0;
  };
  struct Reach {
    float distance, squared;  ///< how far to look [m]; what is nearer is in question [m²]
  };
  struct Gathering;

  void gather_in(const Gathering& gathering, std::uint32_t block, Scratch& scratch,
                 HostBuffers<float>& buffers) const;
  void find_lookers(const Gathering& gathering, std::uint32_t block, Scratch& scratch) const;
  bool collect(const Gathering& gathering, float distance, std::span<const Looker> lookers,
               int cells_across_max, Scratch& scratch) const;
  void add_block(const Gathering& gathering, float distance, std::uint32_t block, const glm::vec3& low,
                 const glm::vec3& high, Scratch& scratch) const;
  void add_point(const glm::vec4& x, std::uint32_t place, std::uint32_t from, Scratch& scratch) const;
  template <class Visit>
  bool each_near(const Gathering& gathering, const Reach& reach, std::uint32_t p, Scratch& scratch,
                 Visit&& visit) const;
  bool boxes_near(const Search& search, float distance, const glm::vec3& x, std::uint32_t block,
                  std::uint32_t particle) const;
  void list_pairs(const Gathering& gathering, std::uint32_t p, Scratch& scratch,
                  HostBuffers<float>& buffers) const;
  void list_surfaces(const Gathering& gathering, const Looker& looker, Scratch& scratch,
                     HostBuffers<float>& buffers) const;
  void finish(HostBuffers<float>& buffers);

  const CollisionView<float>& view_;
  const Kernels& kernels_;
  PatchGrid patches_;
  std::vector<Scratch> scratch_;  ///< of each thread
};

}  // namespace weft::native
