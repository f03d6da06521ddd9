// self_contact: pushes pairs that are nearer than their limit apart. Declaration and CPU mirror.
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
        position_(buffers[BufferId::position]),
        velocity_(buffers[BufferId::velocity]),
        counts_(buffers.words_of(BufferId::pair_count)),
        places_(buffers.words_of(BufferId::pair_places)),
        touches_(buffers.words_of(BufferId::touch_count)) {}

  /// Moves x and v of particle p as docs/float-form.md "Self-collision" says.
  void apply(std::uint32_t p, glm::vec<4, T>& x, glm::vec<4, T>& v) {
    if (touches_[p] == 0 || x.w == T(0)) return;
    touching_.clear();
    for (std::size_t k = 0; k < counts_[p]; ++k) {
      const std::uint32_t other = view_.particle_at(places_[k * position_.size() + p]);
      if (squared_distance(position_[p], position_[other]) < view_.limit(p, other).squared)
        touching_.push_back(other);
    }
    std::ranges::sort(touching_);
    Vec3<T> push(T(0)), kick(T(0));
    for (const std::uint32_t other : touching_) add(p, other, push, kick);
    x = glm::vec<4, T>(Vec3<T>(x) + push, x.w);
    v = glm::vec<4, T>(Vec3<T>(v) + kick, v.w);
  }

 private:
  void add(std::uint32_t p, std::uint32_t other, Vec3<T>& push, Vec3<T>& kick) const {
    const T w = position_[p].w + position_[other].w;
    if (w == T(0)) return;
    const T busier = static_cast<T>(std::max(touches_[p], touches_[other]));
    const T share = (position_[p].w / w) / busier;
    const Vec3<T> d = Vec3<T>(position_[other]) - Vec3<T>(position_[p]);
    const T q = dot3(d, d);
    const bool apart = q > static_cast<T>(shared::kTinyLengthSquared);
    const T l = apart ? std::sqrt(q) : T(0);
    const Vec3<T> n = apart ? d * (T(1) / l) : Vec3<T>(T(0), p < other ? T(1) : T(-1), T(0));
    const T depth = std::max(view_.limit(p, other).limit - l, T(0));
    push = push - (share * depth) * n;
    const T closing = dot3(Vec3<T>(velocity_[other]) - Vec3<T>(velocity_[p]), n);
    if (closing < T(0)) kick = kick + (share * closing) * n;
  }

  const CollisionView<T>& view_;
  const std::vector<glm::vec<4, T>>&position_, &velocity_;
  const std::vector<std::uint32_t>&counts_, &places_, &touches_;
  std::vector<std::uint32_t> touching_;  // of the particle at hand, ascending
};

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const CollisionView<T> view(context.model);
  const Grid& grid = context.model.grid;
  auto& position_next = buffers[BufferId::position_next];
  auto& velocity_next = buffers[BufferId::velocity_next];
  position_next.resize(grid.count());
  velocity_next.resize(grid.count());
  parallel_rows(grid.rows(), grid.nx, [&](std::uint32_t begin, std::uint32_t end) {
    Response<T> response(view, buffers);
    for (std::uint32_t p = begin * grid.nx; p < end * grid.nx; ++p) {
      glm::vec<4, T> x = std::as_const(buffers)[BufferId::position][p];
      glm::vec<4, T> v = std::as_const(buffers)[BufferId::velocity][p];
      response.apply(p, x, v);
      position_next[p] = x;
      velocity_next[p] = glm::vec<4, T>(Vec3<T>(v), T(0));
    }
  });
}

}  // namespace

const Pass self_contact{
    .name = "self_contact",
    .about = "self-collision: pushes pairs apart to their limit and takes their approach",
    .domain = collision_domain,
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
    .swaps_state = true,
    .interval = contact_interval,
};

}  // namespace weft
