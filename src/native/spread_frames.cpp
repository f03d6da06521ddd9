// One look hands rows to the threads; the plane that the cloth is seen in is that of its mean edges.
#include "native/spread_frames.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <iterator>
#include <utility>

#include "passes/lists.h"

namespace weft::native {
namespace {

/// Two axes of length 1 and at right angles, as near to two directions as can be.
struct Plane {
  glm::dvec3 along, down;
};
Plane plane_of(glm::dvec3 along, glm::dvec3 down) {
  along = glm::normalize(along), down = glm::normalize(down);
  const glm::dvec3 sum = std::sqrt(0.5) * glm::normalize(along + down),
                   rest = std::sqrt(0.5) * glm::normalize(along - down);
  return {sum + rest, sum - rest};
}

glm::dvec3 vector_at(const float* first, std::size_t stride) {
  return {first[0], first[stride], first[2 * stride]};
}

/// That of the mean edges: what lies between them cancels out.
Plane mean_plane(const Cloth& cloth, const std::vector<const float*>& rows) {
  const std::size_t last = cloth.nx() - 1;
  const auto place = [&](std::size_t i, std::size_t j) {
    return vector_at(rows[j] + kColumns + i, cloth.sheet().stride);
  };
  glm::dvec3 along(0.0), down(0.0);
  for (std::size_t j = 0; j < rows.size(); ++j) along += place(last, j) - place(0, j);
  for (std::size_t i = 0; i <= last; ++i) down += place(i, rows.size() - 1) - place(i, 0);
  return plane_of(along, down);
}

/// Of the particles of the middle row; any velocity would do.
glm::dvec3 mean_velocity(const Cloth& cloth, const std::vector<const float*>& rows) {
  const std::size_t stride = cloth.sheet().stride;
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i < cloth.nx(); ++i)
    sum += vector_at(rows[rows.size() / 2] + kColumns + i + 3 * stride, stride);
  return sum / static_cast<double>(cloth.nx());
}

void copy(float (&to)[3], const glm::dvec3& from) {
  for (int axis = 0; axis < 3; ++axis) to[axis] = static_cast<float>(from[axis]);
}

}  // namespace

SpreadFrames::SpreadFrames(Cloth& cloth, const Kernels& kernels, const Plan& plan, const Model& model)
    : cloth_(cloth),
      kernels_(kernels),
      watch_(plan, model),
      spacing_m_(model.grid.spacing_m),
      shares_motion_(shares_motion(model)) {
  for (std::size_t j = 0; j < cloth.rows(); ++j) rows_.push_back(cloth.row(j));
}

bool SpreadFrames::is_spread_by(double margin, SpreadState& found, Crew& crew, std::uint32_t threads) const {
  const Plane plane = mean_plane(cloth_, rows_);
  SpreadLook all{.stride = cloth_.sheet().stride,
                 .nx = cloth_.nx(),
                 .ny = cloth_.ny(),
                 .rows = rows_.data(),
                 .spread_min = static_cast<float>(watch_.bound().spread_min(margin) * spacing_m_),
                 .local_min = static_cast<float>(watch_.bound().local_min(margin) * spacing_m_)};
  copy(all.along, plane.along);
  copy(all.down, plane.down);
  const glm::dvec3 shared = shares_motion_ ? mean_velocity(cloth_, rows_) : glm::dvec3(0.0);
  copy(all.shared_speed, shared);
  std::vector<SpreadLook> looks(threads, all);
  crew.run(threads, [&](std::uint32_t own) {
    looks[own].first = own * rows_.size() / threads;
    looks[own].last = (own + std::size_t{1}) * rows_.size() / threads;
    kernels_.look_how_spread(looks[own]);
  });
  for (const SpreadLook& look : looks) {
    if (look.unsound != 0) return false;
    all.apart2 = std::max(all.apart2, look.apart2);
    all.speed2 = std::max(all.speed2, look.speed2);
    all.place2 = std::max(all.place2, look.place2);
    all.longest2 = std::max(all.longest2, look.longest2);
  }
  // The grid of cells has room for what is not stretched like mad, and says where it has none.
  if (all.longest2 > std::pow(SpreadBound::kLongestEdge * spacing_m_, 2)) return false;
  constexpr double kUp = 1.0 + 1e-5;  // for what rounding took away
  found = {.margin = margin,
           .apart_m_s = kUp * std::sqrt(double{all.apart2}),
           .shared_m_s = glm::length(shared),
           .speed_m_s = kUp * std::sqrt(double{all.speed2}),
           .place_m = kUp * std::sqrt(double{all.place2})};
  return true;
}

/// The widest margin from `margin` on by which the cloth is spread.
SpreadState SpreadFrames::look(std::size_t& margin, Crew& crew, std::uint32_t threads) const {
  SpreadState found;
  for (; margin < std::size(SpreadBound::kMargins); ++margin)
    if (is_spread_by(SpreadBound::kMargins[margin], found, crew, threads)) return found;
  return {};
}

bool SpreadFrames::begin_frame(HostBuffers<float>& buffers, Crew& crew, std::uint32_t threads) {
  auto& state = buffers.words_of(BufferId::collision_state);
  if (std::exchange(under_way_, false)) watch_.end_frame(true);
  // Whoever is held back at a frame's end may be so again at the next one's start, by lists that there are.
  const bool held = std::exchange(held_back_, state[shared::kHeldBack]) != state[shared::kHeldBack];
  if (held || !watch_.tries_frame()) return false;
  margin_ = 0;
  now_ = look(margin_, crew, threads);
  if (now_.margin < 0.0) {
    watch_.pass_frames();
    return false;
  }
  kept_words_ = state;
  count_lists(buffers);
  end_lists(buffers);
  state[shared::kListsArmed] = 0;
  state[shared::kSmallestGap] = shared::kInfinity;
  return under_way_ = true;
}

std::uint32_t SpreadFrames::substeps(double drift_s, std::uint32_t most) const {
  return watch_.substeps_from(now_, drift_s, most);
}

bool SpreadFrames::stayed_spread(double drift_s, std::uint32_t substeps, float kick2, Crew& crew,
                                 std::uint32_t threads) {
  const SpreadState end = look(margin_, crew, threads);
  const bool stayed = watch_.stayed_spread(now_, end, drift_s, substeps, kick2);
  now_ = end;
  return stayed;
}

void SpreadFrames::take_back_frame(HostBuffers<float>& buffers) {
  buffers.words_of(BufferId::collision_state) = kept_words_;
  under_way_ = false;
  watch_.end_frame(false);
}

}  // namespace weft::native
