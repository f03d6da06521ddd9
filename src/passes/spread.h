// What the mirrors of frames that may stay spread out share: which words of spread_state say what, and
// whether some velocity changed by more than the host allows. docs/float-form.md "Spread".
#pragma once
#include <atomic>
#include <bit>
#include <glm/vec3.hpp>
#include <vector>

#include "passes/contact.h"
#include "passes/host_buffers.h"
#include "shared/spread.h"

namespace weft {

inline glm::vec3 spread_vector(const std::vector<std::uint32_t>& words, std::uint32_t word) {
  return {std::bit_cast<float>(words[word]), std::bit_cast<float>(words[word + 1]),
          std::bit_cast<float>(words[word + 2])};
}
inline void put_spread_vector(std::vector<std::uint32_t>& words, std::uint32_t word, const glm::vec3& v) {
  for (std::uint32_t axis = 0; axis < 3; ++axis)
    words[word + axis] = std::bit_cast<std::uint32_t>(v[static_cast<int>(axis)]);
}

/// What the mirror of `integrate` tells, where the host asks.
template <class T>
class SpreadTeller {
 public:
  /// @param touches  whether the pass moves particles by contact
  SpreadTeller(HostWords& buffers, T drift, bool touches)
      : words_(buffers.words_of(BufferId::spread_state)), drift_(drift), touches_(touches && drift > T(0)) {
    if (words_.empty() || words_[shared::kSpreadKickMost2] == 0) return;
    asked_ = true;
    most2_ = static_cast<T>(std::bit_cast<float>(words_[shared::kSpreadKickMost2]));
  }
  SpreadTeller(const SpreadTeller&) = delete;
  SpreadTeller& operator=(const SpreadTeller&) = delete;
  ~SpreadTeller() {
    if (far_) words_[shared::kSpreadKicked] = 1;
  }

  /// Of a free particle that came from x0 with v0 to x1 with v1; any thread may call it.
  void look(const glm::vec<3, T>& x0, const glm::vec<3, T>& v0, const glm::vec<3, T>& x1,
            const glm::vec<3, T>& v1) {
    if (!asked_) return;
    bool far = is_farther(v1 - v0, most2_);
    if (touches_) {
      const glm::vec<3, T> promised = drift_ * v0;
      far = far || is_farther((x1 - x0) - promised, (drift_ * drift_) * most2_);
    }
    if (far) far_.store(true, std::memory_order_relaxed);
  }

 private:
  static bool is_farther(const glm::vec<3, T>& d, T most2) { return !(dot3(d, d) <= most2); }

  std::vector<std::uint32_t>& words_;
  T drift_, most2_ = T(0);
  bool touches_, asked_ = false;
  std::atomic<bool> far_{false};
};

}  // namespace weft
