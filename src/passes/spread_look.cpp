// spread_look: by which margins the cloth is spread out over a plane, and how it moves. Declaration and CPU
// mirror.
#include <algorithm>
#include <bit>
#include <cmath>

#include "passes/folds.h"
#include "passes/passes.h"
#include "passes/spread.h"

namespace weft {
namespace {

using V = glm::vec3;

/// A cell's edges: along of both rows, down of both columns.
struct Cell {
  V top, side, bottom, far;
};

/// The symmetric part of a triangle's slope as a frame has it: a, b on its diagonal, m off it.
struct Slope {
  float a, b, m;
  Slope(const Frame<float>& frame, const V& along, const V& down)
      : a(dot3(frame.along, along)),
        b(dot3(frame.down, down)),
        m(0.5f * (dot3(frame.along, down) + dot3(frame.down, along))) {}
  bool goes_along(float least) const {
    const float first = a - least, second = b - least;
    return first >= 0.0f && second >= 0.0f && first * second >= m * m;
  }
};

/// What one look finds.
class Look {
 public:
  Look(const Grid& grid, const HostBuffers<float>& buffers)
      : grid_(grid),
        words_(buffers.words_of(BufferId::spread_state)),
        position_(buffers[BufferId::position]),
        velocity_(buffers[BufferId::velocity]),
        before_(buffers[BufferId::velocity_next]),
        plane_{spread_vector(words_, shared::kSpreadAxis1), spread_vector(words_, shared::kSpreadAxis2)},
        shared_v_(spread_vector(words_, shared::kSpreadShared)),
        margins_((1u << shared::kSpreadMargins) - (1u << words_[shared::kSpreadFirst])) {}

  /// Takes in particle (i, j) and the cell whose first it is.
  void take(std::uint32_t i, std::uint32_t j) {
    const bool has_right = i + 1 < grid_.nx, has_below = j + 1 < grid_.ny;
    const std::uint32_t right = has_right ? i + 1 : i, below = has_below ? j + 1 : j;
    const V v = speed(velocity_, i, j), own_v = v - shared_v_, along_v = speed(velocity_, right, j) - v,
            down_v = speed(velocity_, i, below) - v;
    const V x = place(i, j), kick = v - speed(before_, i, j);
    const float place2 = dot3(x, x), speed2 = dot3(own_v, own_v), along2 = dot3(along_v, along_v),
                down2 = dot3(down_v, down_v);
    if (!std::isfinite((place2 + speed2) + (along2 + down2))) fails_ = margins_;
    const V top = place(right, j) - x, side = place(i, below) - x;
    put(shared::kSpreadPlace2, place2);
    put(shared::kSpreadSpeed2, speed2);
    put(shared::kSpreadApart2, larger(along2, down2));
    put(shared::kSpreadLongest2, larger(dot3(top, top), dot3(side, side)));
    put(shared::kSpreadKick2, dot3(kick, kick));
    if (has_right && has_below) fails_ |= short_at(i, j);
  }

  void tell(std::vector<std::uint32_t>& words) const {
    for (std::uint32_t k = 0; k < shared::kSpreadFoundCount; ++k)
      words[shared::kSpreadFound + k] =
          std::max(words[shared::kSpreadFound + k], std::bit_cast<std::uint32_t>(found_[k]));
    words[shared::kSpreadShort] |= fails_;
  }

  /// What the next frame chooses its plane by.
  void tell_borders(std::vector<std::uint32_t>& words) const {
    V along(0.0f), down(0.0f);
    const std::uint32_t last = grid_.nx - 1, bottom = grid_.ny - 1, rest = shared::kSpreadSamples - 1;
    for (std::uint32_t k = 0; k < shared::kSpreadSamples; ++k) {
      const std::uint32_t j = k * bottom / rest, i = k * last / rest;
      along = along + (place(last, j) - place(0, j));
      down = down + (place(i, bottom) - place(i, 0));
    }
    put_spread_vector(words, shared::kSpreadAlong, along);
    put_spread_vector(words, shared::kSpreadDown, down);
    put_spread_vector(words, shared::kSpreadMiddle, speed(velocity_, grid_.nx / 2, grid_.ny / 2));
  }

 private:
  V place(std::uint32_t i, std::uint32_t j) const { return V(position_[grid_.index(i, j)]); }
  V speed(const std::vector<glm::vec4>& of, std::uint32_t i, std::uint32_t j) const {
    return V(of[grid_.index(i, j)]);
  }
  static float larger(float a, float b) { return a > b ? a : b; }
  void put(std::uint32_t word, float value) {
    float& most = found_[word - shared::kSpreadFound];
    most = larger(value, most);
  }
  Cell cell(std::uint32_t i, std::uint32_t j) const {
    const V here = place(i, j), right = place(i + 1, j), under = place(i, j + 1),
            across = place(i + 1, j + 1);
    return {right - here, under - here, across - under, across - right};
  }

  /// Of the margins in `asked`, those by which the cell is not spread in the frame.
  std::uint32_t short_in(const Frame<float>& frame, const Cell& cell, std::uint32_t least_word,
                         std::uint32_t asked) const {
    const Slope above(frame, cell.top, cell.side), below(frame, cell.bottom, cell.far);
    std::uint32_t fails = 0;
    for (std::uint32_t margin = 0; margin < shared::kSpreadMargins; ++margin) {
      const auto least = std::bit_cast<float>(words_[least_word + margin]);
      const bool asks = (asked >> margin & 1u) != 0;
      if (asks && !(above.goes_along(least) && below.goes_along(least))) fails |= 1u << margin;
    }
    return fails;
  }
  /// The same in the frame of the nine cells round it.
  std::uint32_t short_locally(std::uint32_t i, std::uint32_t j, std::uint32_t asked) const {
    const std::uint32_t i0 = std::max(i, 1u) - 1, j0 = std::max(j, 1u) - 1,
                        i1 = std::min(i + 2, grid_.nx - 1), j1 = std::min(j + 2, grid_.ny - 1);
    const V first = place(i0, j0), beyond = place(i1, j0), under = place(i0, j1), last = place(i1, j1);
    const Frame<float> frame =
        frame_of<float>((beyond - first) + (last - under), (under - first) + (last - beyond));
    std::uint32_t fails = 0;
    for (std::uint32_t y = j0; y < j1; ++y)
      for (std::uint32_t x = i0; x < i1; ++x)
        fails |= short_in(frame, cell(x, y), shared::kSpreadLocalLeast, asked);
    return fails;
  }
  std::uint32_t short_at(std::uint32_t i, std::uint32_t j) const {
    const Cell own = cell(i, j);
    const std::uint32_t asked = short_in(plane_, own, shared::kSpreadLocalLeast, margins_);
    const std::uint32_t fails = short_in(plane_, own, shared::kSpreadLeast, asked), rest = asked & ~fails;
    return fails | (rest != 0 ? short_locally(i, j, rest) : 0);
  }

  const Grid& grid_;
  const std::vector<std::uint32_t>& words_;
  const std::vector<glm::vec4>&position_, &velocity_, &before_;
  Frame<float> plane_;
  V shared_v_;
  std::uint32_t margins_;  ///< a bit for each that is asked for
  std::array<float, shared::kSpreadFoundCount> found_{};
  std::uint32_t fails_ = 0;
};

void mirror_f32(const MirrorContext& context, HostBuffers<float>& buffers) {
  const Grid& grid = context.model.grid;
  Look look(grid, buffers);
  for (std::uint32_t j = 0; j < grid.ny; ++j)
    for (std::uint32_t i = 0; i < grid.nx; ++i) look.take(i, j);
  auto& words = buffers.words_of(BufferId::spread_state);
  look.tell(words);
  look.tell_borders(words);
}

/// Plans in double have no such frames: what the float mirror says of the same floats.
void mirror_f64(const MirrorContext& context, HostBuffers<double>& buffers) {
  HostBuffers<float> floats;
  floats.words = buffers.words;
  for (const BufferId id : {BufferId::position, BufferId::velocity, BufferId::velocity_next})
    floats[id].assign(buffers[id].begin(), buffers[id].end());
  mirror_f32(context, floats);
  buffers.words = std::move(floats.words);
}

Range domain(const Model& model) {
  const Grid& grid = model.grid;
  if (!model.scene.self_collision || grid.cloths != 1) return {};
  return {.x = grid.nx, .y = (grid.ny + shared::kSpreadRows - 1) / shared::kSpreadRows};
}

}  // namespace

const Pass spread_look{
    .name = "spread_look",
    .about = "self-collision: is the cloth spread out so that nothing can be near anything else?",
    .domain = domain,
    .mirror_f32 = mirror_f32,
    .mirror_f64 = mirror_f64,
    .takes_texels = true,
};

}  // namespace weft
