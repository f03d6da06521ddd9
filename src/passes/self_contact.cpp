// self_contact: stops pairs that are nearer than their limit and makes them part. Declaration and CPU mirror.
#include <utility>

#include "passes/collision.h"
#include "passes/contact.h"
#include "passes/parallel.h"
#include "passes/passes.h"

namespace weft {
namespace {

template <class T>
using Vec3 = glm::vec<3, T>;

/// One particle's Jacobi step over the others that touch it.
template <class T>
class Response {
 public:
  Response(const CollisionView<T>& view, const HostBuffers<T>& buffers)
      : view_(view),
        position_(buffers[BufferId::near_position]),
        velocity_(buffers[BufferId::near_velocity]),
        counts_(buffers.words_of(BufferId::pair_count)),
        places_(buffers.words_of(BufferId::pair_places)),
        touches_(buffers.words_of(BufferId::touch_weight)),
        sums_(buffers.words_of(BufferId::surface_sums)) {}

  bool moves(std::uint32_t p) const { return touches_[p] != 0 && position_[p].w != T(0); }

  /// How fast particle p goes then, as docs/float-form.md "Self-collision" says.
  void apply(std::uint32_t p, glm::vec<4, T>& v) {
    touching_.clear();
    for (std::size_t k = 0; k < counts_[p]; ++k) {
      const std::uint32_t other = view_.particle_at(places_[k * position_.size() + p]);
      if (squared_distance(position_[p], position_[other]) < view_.limit(p, other).squared)
        touching_.push_back(other);
    }
    std::ranges::sort(touching_);
    const T w = position_[p].w;
    Vec3<T> kick = w * (summed(p) * (T(1) / static_cast<T>(shared::kKickQuantum_1)));
    for (const std::uint32_t other : touching_) add(p, other, kick);
    v = glm::vec<4, T>(Vec3<T>(velocity_[p]) + kick, T(0));
  }

 private:
  Vec3<T> summed(std::uint32_t p) const {
    Vec3<T> sum;
    for (std::uint32_t axis = 0; axis < 3; ++axis)
      sum[static_cast<int>(axis)] =
          static_cast<T>(static_cast<std::int32_t>(sums_[axis * position_.size() + p]));
    return sum;
  }

  void add(std::uint32_t p, std::uint32_t other, Vec3<T>& kick) const {
    const T w = position_[p].w + position_[other].w;
    if (w == T(0)) return;
    const T mine = position_[p].w * touching_in<T>(touches_, p),
            its = position_[other].w * touching_in<T>(touches_, other);
    const T share = position_[p].w / (mine + its);
    const Vec3<T> d = Vec3<T>(position_[other]) - Vec3<T>(position_[p]);
    const T q = dot3(d, d);
    const bool apart = q > static_cast<T>(shared::kTinyLengthSquared);
    const T l = apart ? std::sqrt(q) : T(0);
    const Vec3<T> n = apart ? d * (T(1) / l) : Vec3<T>(T(0), p < other ? T(1) : T(-1), T(0));
    const T parting = parting_speed(view_, view_.limit(p, other).limit - l);
    const Vec3<T> relative = Vec3<T>(velocity_[other]) - Vec3<T>(velocity_[p]);
    const T approach = dot3(relative, n), closing = parting - approach;
    if (!(closing > T(0))) return;
    kick = kick - (share * closing) * n;
    if (!(view_.friction > T(0))) return;
    const Vec3<T> along = relative - approach * n;
    const T speed = std::sqrt(dot3(along, along)), cut = view_.friction * closing;
    kick = kick + (share * (speed > cut ? cut / speed : T(1))) * along;
  }

  const CollisionView<T>& view_;
  const std::vector<glm::vec<4, T>>&position_, &velocity_;
  const std::vector<std::uint32_t>&counts_, &places_, &touches_, &sums_;
  std::vector<std::uint32_t> touching_;  // of the particle at hand, ascending
};

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  if (!touching_somewhere(buffers)) return;
  const CollisionView<T> view(context.model);
  const Grid& grid = context.model.grid;
  auto& velocity = buffers[BufferId::velocity];
  parallel_rows(grid.rows(), grid.nx, [&](std::uint32_t begin, std::uint32_t end) {
    Response<T> response(view, buffers);
    for (std::uint32_t p = begin * grid.nx; p < end * grid.nx; ++p)
      if (response.moves(p)) response.apply(p, velocity[p]);
  });
  buffers.words_of(BufferId::collision_state)[shared::kTouchGroups] = 0;
}

}  // namespace

const Pass self_contact =
    collision_pass("self_contact", "self-collision: gives particles what their contacts do to them",
                   mirror<float>, mirror<double>, shared::kTouchGroups);

}  // namespace weft
