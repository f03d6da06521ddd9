// The buffer dictionary on the host: the same buffers the GPU has, held as scalars of type T, so a mirror
// reads and writes what the shader reads and writes.
#pragma once
#include <array>
#include <cstdint>
#include <glm/vec4.hpp>
#include <string_view>
#include <vector>

#include "shared/buffers.h"
#include "shared/collision.h"
#include "shared/params.h"

namespace weft {

/// One enumerator a row of shared/buffers.h, in binding order.
enum class BufferId : std::uint32_t {
#define WEFT_ROW(name, binding, element, unit) name = binding,
  WEFT_BUFFERS(WEFT_ROW)
#undef WEFT_ROW
};

struct BufferRow {
  BufferId id;
  std::string_view name, element, unit;
  std::uint32_t element_bytes;
};

inline constexpr std::array kBufferRows = {
#define WEFT_ROW(name, binding, element, unit) \
  BufferRow{BufferId::name, #name, #element, unit, std::uint32_t{sizeof(shared::element)}},
    WEFT_BUFFERS(WEFT_ROW)
#undef WEFT_ROW
};
inline constexpr std::size_t kBufferCount = kBufferRows.size();

constexpr const BufferRow& row_of(BufferId id) { return kBufferRows[static_cast<std::size_t>(id)]; }

/// Whether the buffer is integers: counts, indices, flags.
constexpr bool holds_words(BufferId id) { return row_of(id).element == "uint"; }

/// Buffers on the host: vectors in T, integers as they are. `params`, `substeps` and `collision` have no
/// place here: mirrors take the Model and the schedule row instead, so that they check the tables too.
template <class T>
struct HostBuffers {
  std::array<std::vector<glm::vec<4, T>>, kBufferCount> vec4;
  std::array<std::vector<std::uint32_t>, kBufferCount> words;
  std::vector<glm::vec<4, T>>& operator[](BufferId id) { return vec4[static_cast<std::size_t>(id)]; }
  const std::vector<glm::vec<4, T>>& operator[](BufferId id) const {
    return vec4[static_cast<std::size_t>(id)];
  }
  std::vector<std::uint32_t>& words_of(BufferId id) { return words[static_cast<std::size_t>(id)]; }
  const std::vector<std::uint32_t>& words_of(BufferId id) const {
    return words[static_cast<std::size_t>(id)];
  }
};

}  // namespace weft
