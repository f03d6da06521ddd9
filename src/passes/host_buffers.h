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
#include "shared/reach.h"
#include "shared/watch.h"

namespace weft {

/// One enumerator a row of shared/buffers.h, in binding order.
enum class BufferId : std::uint32_t {
#define WEFT_ROW(name, binding, element, unit) name = binding,
  WEFT_BUFFERS(WEFT_ROW)
#undef WEFT_ROW
};

/// What the dictionary's elements are in a plan that computes in T.
template <class T>
struct Elements {
  using real4 = glm::vec<4, T>;
  using vec4 = glm::vec4;  // in float whatever the plan computes in
  using uint = std::uint32_t;
  using Params = shared::ParamsOf<T>;
  using Collision = shared::CollisionOf<T>;
  using MovedPin = shared::MovedPinOf<T>;
  using Tether = shared::TetherOf<T>;
};

struct BufferRow {
  BufferId id;
  std::string_view name, element, unit;
  std::uint32_t element_bytes;         ///< of plans in float
  std::uint32_t element_bytes_double;  ///< of plans in double
};

inline constexpr std::array kBufferRows = {
#define WEFT_ROW(name, binding, element, unit)               \
  BufferRow{BufferId::name,                                  \
            #name,                                           \
            #element,                                        \
            unit,                                            \
            std::uint32_t{sizeof(Elements<float>::element)}, \
            std::uint32_t{sizeof(Elements<double>::element)}},
    WEFT_BUFFERS(WEFT_ROW)
#undef WEFT_ROW
};
inline constexpr std::size_t kBufferCount = kBufferRows.size();

constexpr const BufferRow& row_of(BufferId id) { return kBufferRows[static_cast<std::size_t>(id)]; }

/// Whether the buffer is integers: counts, indices, flags.
constexpr bool holds_words(BufferId id) { return row_of(id).element == "uint"; }

/// Whether the buffer is vectors in float whatever the plan computes in, as drawing reads them.
constexpr bool holds_floats(BufferId id) { return row_of(id).element == "vec4"; }

/// Whether the buffer is vectors, in the plan's precision or in float.
constexpr bool holds_vectors(BufferId id) { return row_of(id).element == "real4" || holds_floats(id); }

/// The buffers of integers on the host.
struct HostWords {
  std::array<std::vector<std::uint32_t>, kBufferCount> words;
  std::vector<std::uint32_t>& words_of(BufferId id) { return words[static_cast<std::size_t>(id)]; }
  const std::vector<std::uint32_t>& words_of(BufferId id) const {
    return words[static_cast<std::size_t>(id)];
  }
};

/// Buffers on the host: vectors in T, integers as they are. `params`, `substeps`, `collision`,
/// `moved_pins` and `tethers` have no place here: mirrors take the Model and the schedule row instead, so
/// that they check the tables too.
template <class T>
struct HostBuffers : HostWords {
  std::array<std::vector<glm::vec<4, T>>, kBufferCount> vec4;
  std::vector<glm::vec<4, T>>& operator[](BufferId id) { return vec4[static_cast<std::size_t>(id)]; }
  const std::vector<glm::vec<4, T>>& operator[](BufferId id) const {
    return vec4[static_cast<std::size_t>(id)];
  }
};

}  // namespace weft
