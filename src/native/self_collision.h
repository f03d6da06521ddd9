// The passes of self-collision that have vector code: they read the cloth's rows and write its buffers.
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "native/cloth.h"
#include "native/crew.h"
#include "native/motion_watch.h"
#include "native/near_lists.h"
#include "native/surface_contacts.h"
#include "passes/collision.h"

namespace weft::native {

class SelfCollision {
 public:
  /// @param model    with [self_collision]; it and the cloth outlive this
  /// @param watches  whether sweeps tell of long ways (sweep_watches_motion)
  SelfCollision(Cloth& cloth, const Kernels& kernels, const Model& model, bool watches);

  /// Whether the pass of the plan runs here.
  static bool has(const Pass& pass);
  /// Whether it reads positions in the buffers, too.
  static bool reads_buffers(const Pass& pass);
  /// One dispatch of such a pass, in that many of the crew's threads. Returns whether rows have changed.
  bool run(const Pass& pass, const MirrorContext& context, HostBuffers<float>& buffers, Crew& crew,
           std::uint32_t threads);
  /// At cell_count, where it leaves nothing to do for all passes that make lists: nobody looks for others, as
  /// last time. Otherwise returns false, and what has changed is only what those passes make anew.
  /// @param need_positions  called before positions in the buffers are read, which is seldom
  bool make_empty_lists(HostBuffers<float>& buffers, Crew& crew, std::uint32_t threads,
                        const std::function<void()>& need_positions);
  /// Whom sweeps have to tell; null: nobody.
  LeapWatch* watch() { return watch_ ? &*watch_ : nullptr; }
  /// Particles have been moved otherwise.
  void forget_motion() {
    if (watch_) watch_->forget();
  }
  std::uint64_t bytes() const;

 private:
  void carry_along(const Model& model, HostBuffers<float>& buffers) const;
  bool check_motion(const MirrorContext& context, HostBuffers<float>& buffers, Crew& crew,
                    std::uint32_t threads);
  bool measure_motion(HostBuffers<float>& buffers, Crew& crew, std::uint32_t threads, bool& stale);
  bool look_at_motion(HostBuffers<float>& buffers, Crew& crew, std::uint32_t threads, bool& stale);
  bool hold_back(std::span<const std::uint32_t> particles, HostBuffers<float>& buffers);
  std::size_t look_at_patches(HostBuffers<float>& buffers, Crew& crew, std::uint32_t threads);
  void box_blocks(HostBuffers<float>& buffers, Crew& crew, std::uint32_t threads);
  void count_cells(HostBuffers<float>& buffers, Crew& crew, std::uint32_t threads);
  void look_near(HostBuffers<float>& buffers, Crew& crew, std::uint32_t threads);
  std::uint32_t looks_beside(std::size_t x, std::size_t y, const std::uint8_t* bends) const;
  void make_room_for_tree();
  std::size_t leaf_rows() const;
  template <class Act>
  void in_each_row_of(std::size_t first, std::size_t last, const Act& act) const;
  /// Cells 4·patch + k of a cloth that has so many patches before it.
  struct LeftOver {
    std::span<const std::uint32_t> cells;
    std::uint32_t patches_before;
  };
  void look_at_rows(std::size_t first, std::size_t last, PatchLook& look, HostBuffers<float>& buffers,
                    std::vector<LeftOver>& left_over);
  void look_closely(const LeftOver& left_over, HostBuffers<float>& buffers) const;

  Cloth& cloth_;
  const Kernels& kernels_;
  CollisionView<float> view_;
  SurfaceContacts contacts_;
  NearLists near_lists_;
  bool shares_motion_;
  std::optional<MotionWatch> watch_;
  std::vector<const float*> rows_;  ///< by row of all cloths
  std::vector<float> scratch_;      ///< of each thread
  std::vector<std::uint32_t> left_over_;
  std::vector<std::vector<LeftOver>> creased_;  ///< what look_at_patches left over, by thread
  std::vector<NearNode> nodes_;                 ///< of all levels of the tree
  std::vector<NearLevel> levels_;               ///< the leaves first
  /// By patch, one more on every side of each cloth: as cell_count has said.
  std::vector<std::uint8_t> bends_;
};

}  // namespace weft::native
