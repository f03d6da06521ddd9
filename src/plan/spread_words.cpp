// Words of spread_state.
#include "plan/spread_words.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>

#include "passes/spread.h"

namespace weft {
namespace {

constexpr double kCheckedKick_m_s = 0.05;  // some probe states stay below it, some do not

void put(std::vector<std::uint32_t>& words, std::uint32_t word, double value) {
  words[word] = std::bit_cast<std::uint32_t>(static_cast<float>(value));
}

}  // namespace

void begin_spread_words(std::vector<std::uint32_t>& words, const SpreadBound& bound, const Model& model,
                        double kick_most_m_s, std::uint32_t widest) {
  std::fill(words.begin(), words.begin() + shared::kSpreadAlong, 0u);
  put(words, shared::kSpreadKickMost2, kick_most_m_s * kick_most_m_s);
  words[shared::kSpreadFirst] = widest;
  for (std::uint32_t k = 0; k < shared::kSpreadMargins; ++k) {
    const double margin = SpreadBound::kMargins[k], spacing_m = model.grid.spacing_m;
    put(words, shared::kSpreadLeast + k, bound.spread_min(margin) * spacing_m);
    put(words, shared::kSpreadLocalLeast + k, bound.local_min(margin) * spacing_m);
  }
}

void put_spread_plane(std::vector<std::uint32_t>& words, const glm::dvec3& along, const glm::dvec3& down,
                      const glm::dvec3& shared_m_s) {
  const glm::dvec3 a = glm::normalize(along), b = glm::normalize(down);
  const glm::dvec3 sum = std::sqrt(0.5) * glm::normalize(a + b),
                   rest = std::sqrt(0.5) * glm::normalize(a - b);
  put_spread_vector(words, shared::kSpreadAxis1, glm::vec3(sum + rest));
  put_spread_vector(words, shared::kSpreadAxis2, glm::vec3(sum - rest));
  put_spread_vector(words, shared::kSpreadShared, glm::vec3(shared_m_s));
}

template <class T>
void ask_for_spread(const Plan& plan, const Model& model, HostBuffers<T>& buffers) {
  auto& words = buffers.words_of(BufferId::spread_state);
  const auto& x = buffers[BufferId::position];
  const Grid& grid = model.grid;
  const auto from_first = [&](std::uint32_t p) { return glm::dvec3(x[p]) - glm::dvec3(x[0]); };
  begin_spread_words(words, SpreadBound(plan, model), model, kCheckedKick_m_s);
  put_spread_plane(words, from_first(grid.nx - 1), from_first(grid.index(0, grid.ny - 1)), glm::dvec3(0.1));
  const auto& velocity = buffers[BufferId::velocity];
  auto& before = buffers[BufferId::velocity_next];
  before.resize(velocity.size());
  std::ranges::transform(velocity, before.begin(), [](const glm::vec<4, T>& v) { return T(0.9) * v; });
}

template void ask_for_spread(const Plan&, const Model&, HostBuffers<float>&);
template void ask_for_spread(const Plan&, const Model&, HostBuffers<double>&);

}  // namespace weft
