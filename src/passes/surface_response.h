// The answer to one contact of surfaces, operation by operation as docs/float-form.md "Surfaces"; what the
// mirror of surface_contact and native share.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "passes/surface.h"

namespace weft {

/// What two touching surfaces give their particles, each contact with its share. Source: Bridson, Fedkiw and
/// Anderson 2002, Robust treatment of collisions, contact and friction for cloth animation, sections 7.1
/// and 7.2.
template <class T>
class SurfaceResponse {
 public:
  using V = glm::vec<3, T>;
  SurfaceResponse(const CollisionView<T>& view, const HostBuffers<T>& buffers)
      : view_(view),
        position_(buffers[BufferId::near_position]),
        velocity_(buffers[BufferId::near_velocity]),
        touches_(buffers.words_of(BufferId::touch_weight)) {}

  /// Calls give(place in surface_sums, units) twelve times, or never.
  template <class Give>
  void add(const SurfacePair<T>& pair, Give&& give_to) const {
    const T w = inverse_mass(pair);
    if (w == T(0) || !(pair.squared > static_cast<T>(shared::kTinyLengthSquared))) return;
    const T share = T(1) / std::max(divisor(pair), static_cast<T>(shared::kWeightMin));
    const T l = std::sqrt(pair.squared);
    const V n = pair.d * (T(1) / l);
    const T apart = parting_speed(view_, view_.surface_limit - l);
    give(pair, velocity_change(pair, n, apart, share) * static_cast<T>(shared::kKickQuantum_1), give_to);
  }

 private:
  using Whole = glm::vec<3, std::int32_t>;

  T inverse_mass(const SurfacePair<T>& pair) const {
    T sum = (pair.weight[0] * pair.weight[0]) * position_[pair.particle[0]].w;
    for (std::size_t m = 1; m < 4; ++m)
      sum = sum + (pair.weight[m] * pair.weight[m]) * position_[pair.particle[m]].w;
    return sum;
  }

  /// The most that all contacts of its particles do to this one, each given as much as this one.
  T divisor(const SurfacePair<T>& pair) const {
    const auto part = [&](std::size_t m) {
      const std::uint32_t p = pair.particle[m];
      return (std::abs(pair.weight[m]) * position_[p].w) * touching_in<T>(touches_, p);
    };
    T sum = part(0);
    for (std::size_t m = 1; m < 4; ++m) sum = sum + part(m);
    return sum;
  }

  V velocity_change(const SurfacePair<T>& pair, const V& n, T apart, T share) const {
    V u = pair.weight[0] * place_in(velocity_, pair.particle[0]);
    for (std::size_t m = 1; m < 4; ++m) u = u + pair.weight[m] * place_in(velocity_, pair.particle[m]);
    const T approach = dot3(u, n);
    const T closing = std::min(apart - approach, static_cast<T>(shared::kClosingMost_m_s));
    if (!(closing > T(0))) return V(T(0));
    const V stop = (share * closing) * n;
    if (!(view_.friction > T(0))) return stop;
    const V along = u - approach * n;
    const T speed = std::sqrt(dot3(along, along)), cut = view_.friction * closing;
    return stop - (share * (speed > cut ? cut / speed : T(1))) * along;
  }

  /// The first side gets `whole`, cut to integers, the second its opposite.
  template <class Give>
  void give(const SurfacePair<T>& pair, const V& whole, Give&& give_to) const {
    const Whole all(whole);
    const std::size_t second_side = pair.edges ? 2 : 1;
    std::array<Whole, 4> given{all, Whole(0), Whole(0), Whole(0)};
    given[second_side] = -all;
    for (std::size_t m = 1; m < 4; ++m) {
      if (m == second_side) continue;
      const std::size_t lead = m < second_side ? 0 : second_side;
      const Whole part = Whole(std::abs(pair.weight[m]) * whole) * (lead == 0 ? 1 : -1);
      given[m] = part;
      given[lead] -= part;
    }
    for (std::size_t m = 0; m < 4; ++m)
      for (int axis = 0; axis < 3; ++axis)
        give_to(static_cast<std::size_t>(axis) * position_.size() + pair.particle[m],
                static_cast<std::uint32_t>(given[m][axis]));
  }

  const CollisionView<T>& view_;
  const std::vector<glm::vec<4, T>>&position_, &velocity_;
  const std::vector<std::uint32_t>& touches_;
};

}  // namespace weft
