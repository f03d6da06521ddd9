// What of a buffer a pass did not write, where both sides were filled with poison before it.
#pragma once
#include <algorithm>
#include <cstring>

#include "passes/host_buffers.h"
#include "sim/pass_runner.h"

namespace weft {

template <class T>
bool is_poison(T value) {
  const T expected = poison<T>();  // by its bits: NaN is not equal to itself
  return std::memcmp(&value, &expected, sizeof value) == 0;
}

template <class T>
void poison_mirror(BufferId id, HostBuffers<T>& host) {
  std::ranges::fill(host.words_of(id), kPoison);
  std::ranges::fill(host[id], glm::vec<4, T>(poison<T>()));
}

/// Where the mirror wrote nothing, a kernel that reads its outputs finds and leaves what was there before.
template <class T>
void restore_poisoned(BufferId id, const HostBuffers<T>& before, HostBuffers<T>& expected) {
  for (std::size_t p = 0; p < expected[id].size(); ++p)
    for (int c = 0; c < 4; ++c)
      if (is_poison(expected[id][p][c])) expected[id][p][c] = before[id][p][c];
}

/// Where neither side wrote, the buffer holds what it held before, on both.
template <class T>
void restore_unwritten(BufferId id, const HostBuffers<T>& before, HostBuffers<T>& got,
                       HostBuffers<T>& expected) {
  const auto& words = before.words_of(id);
  for (std::size_t k = 0; k < words.size(); ++k)
    if (got.words_of(id)[k] == kPoison && expected.words_of(id)[k] == kPoison)
      got.words_of(id)[k] = expected.words_of(id)[k] = words[k];
  const auto& vectors = before[id];
  for (std::size_t p = 0; p < vectors.size(); ++p)
    for (int c = 0; c < 4; ++c)
      if (is_poison(got[id][p][c]) && is_poison(expected[id][p][c]))
        got[id][p][c] = expected[id][p][c] = vectors[p][c];
}

}  // namespace weft
