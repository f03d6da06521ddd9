// Hands rows of patches and of particles to the threads, and what the kernels leave over to the mirrors'
// code.
#include "native/self_collision.h"

#include <algorithm>
#include <array>
#include <utility>

#include "passes/carry.h"
#include "passes/folds.h"
#include "passes/leash.h"
#include "passes/lists.h"
#include "passes/passes.h"
#include "passes/patches.h"

namespace weft::native {
namespace {

constexpr std::array kLooking{&carry,       &pair_check,     &cell_count,    &patch_near,
                              &pair_gather, &surface_gather, &surface_touch, &surface_contact};

/// The cells of the cloth are `a` wide, and nothing within flat_min = 0.55055·a of each other is overlooked.
Smooth smooth_for(const CollisionView<float>& view) {
  constexpr double kBend = 0.016, kLength = 0.95, kShear = 0.2, kApart = 0.62;
  const double a = view.grid.spacing_m;
  const auto squared = [](double x) { return static_cast<float>(x * x); };
  return {squared(kBend * a), squared(kLength * a), static_cast<float>(kShear * a * a), squared(kApart * a)};
}

}  // namespace

SelfCollision::SelfCollision(Cloth& cloth, const Kernels& kernels, const Model& model, bool watches)
    : cloth_(cloth),
      kernels_(kernels),
      view_(model),
      contacts_(view_, kernels),
      near_lists_(view_, kernels),
      shares_motion_(shares_motion(model)),
      left_over_(4 * std::size_t{PatchGrid(model.grid).count()}) {
  for (std::size_t j = 0; j < cloth.rows(); ++j) rows_.push_back(cloth.row(j));
  make_room_for_tree();
  if (watches) watch_.emplace(std::min(view_.layout.stale_m, view_.layout.roam_max_m));
}

void SelfCollision::make_room_for_tree() {
  const PatchGrid patches(view_.grid);
  bends_.resize((patches.nx() + std::size_t{2}) * (patches.ny() + std::size_t{2}) * view_.grid.cloths);
  std::size_t across = (patches.nx() + 3) / 4, down = leaf_rows() * view_.grid.cloths, count = across * down;
  levels_.push_back({.nodes = nullptr, .across = across, .down = down});
  while (across * down > 1) {
    across = (across + 3) / 4, down = (down + 3) / 4;
    levels_.push_back({.nodes = nullptr, .across = across, .down = down});
    count += across * down;
  }
  nodes_.resize(count);
  NearNode* place = nodes_.data();
  for (NearLevel& level : levels_) level.nodes = std::exchange(place, place + level.across * level.down);
}

/// Rows of leaves of one cloth.
std::size_t SelfCollision::leaf_rows() const { return (PatchGrid(view_.grid).ny() + std::size_t{3}) / 4; }

std::uint64_t SelfCollision::bytes() const {
  return scratch_.size() * sizeof(float) + left_over_.size() * sizeof(std::uint32_t) +
         nodes_.size() * sizeof(NearNode) + bends_.size() + contacts_.bytes() + near_lists_.bytes();
}

bool SelfCollision::has(const Pass& pass) { return std::ranges::count(kLooking, &pass) > 0; }

bool SelfCollision::reads_buffers(const Pass& pass) {
  return &pass == &cell_count || &pass == &surface_gather;
}

bool SelfCollision::run(const Pass& pass, const MirrorContext& context, HostBuffers<float>& buffers,
                        Crew& crew, std::uint32_t threads) {
  if (&pass == &carry) carry_along(context.model, buffers);
  if (&pass == &pair_check) return check_motion(context, buffers, crew, threads);
  if (&pass == &cell_count && lists_stale(buffers)) {
    count_cells(buffers, crew, threads);
    if (watch_) watch_->lists_made();
  }
  if (&pass == &patch_near && lists_stale(buffers)) look_near(buffers, crew, threads);
  if (&pass == &surface_touch) contacts_.touch(buffers, crew, threads);
  if (&pass == &surface_contact) contacts_.respond(buffers, crew, threads);
  if (&pass == &surface_gather) {  // and pair_gather, which stands before it
    near_lists_.gather(buffers, crew, threads);
    contacts_.forget_lists();
    if (buffers.words_of(BufferId::collision_state)[shared::kPairsListed] != 0) forget_motion();
  }
  return false;
}

void SelfCollision::carry_along(const Model& model, HostBuffers<float>& buffers) const {
  const std::size_t stride = cloth_.sheet().stride;
  const auto vector_at = [&](std::uint32_t p, std::size_t first) {
    const float* const at = rows_[p / cloth_.nx()] + kColumns + p % cloth_.nx() + first * stride;
    return glm::vec3(at[0], at[stride], at[2 * stride]);
  };
  weft::carry_along(
      model, shares_motion_, buffers, [&](std::uint32_t p) { return vector_at(p, 0); },
      [&](std::uint32_t p) { return vector_at(p, 3); });
}

bool SelfCollision::check_motion(const MirrorContext& context, HostBuffers<float>& buffers, Crew& crew,
                                 std::uint32_t threads) {
  bool stale = begin_check(context, view_, buffers), moved = false;
  const auto& state = buffers.words_of(BufferId::collision_state);
  const bool looks = state[shared::kListsArmed] != 0 && !(watch_ && watch_->all_are_in());
  if (looks && !measure_motion(buffers, crew, threads, stale))
    moved = look_at_motion(buffers, crew, threads, stale);
  end_check(view_, stale, buffers);
  return moved;
}

/// Where nothing is listed, for whoever watches: adds to `stale`. Returns whether that was all there is to
/// look at; otherwise somebody may have to be held back or has no place.
bool SelfCollision::measure_motion(HostBuffers<float>& buffers, Crew& crew, std::uint32_t threads,
                                   bool& stale) {
  if (!watch_ || buffers.words_of(BufferId::collision_state)[shared::kPairsListed] != 0) return false;
  std::vector<MotionLook> looks(threads, {.stride = cloth_.sheet().stride,
                                          .nx = cloth_.nx(),
                                          .rows = rows_.data(),
                                          .built = &buffers[BufferId::built_position][0].x});
  crew.run(threads, [&](std::uint32_t own) {
    looks[own].first = own * cloth_.rows() / threads;
    looks[own].last = (own + std::size_t{1}) * cloth_.rows() / threads;
    kernels_.measure_motion(looks[own]);
  });
  MotionLook all = looks[0];
  for (const MotionLook& look : looks) {
    all.gone2 = std::max(all.gone2, look.gone2);
    all.speed2 = std::max(all.speed2, look.speed2);
    all.place2 = std::max(all.place2, look.place2);
    all.unsound |= look.unsound;
  }
  if (all.unsound != 0 || all.gone2 > view_.roam_max * view_.roam_max) {
    watch_->forget();
    return false;
  }
  stale |= all.gone2 > view_.moved_squared_max;
  watch_->measured(all.gone2, all.speed2, all.place2);
  return true;
}

/// Adds to `stale` and returns whether anybody was held back.
bool SelfCollision::look_at_motion(HostBuffers<float>& buffers, Crew& crew, std::uint32_t threads,
                                   bool& stale) {
  buffers[BufferId::near_position].resize(view_.grid.count());
  const Leash<float> leash(view_, buffers);
  const glm::vec3 &b = leash.with_lists(), &n = leash.with_contacts();
  std::vector<LeashLook> looks(threads, {.stride = cloth_.sheet().stride,
                                         .nx = cloth_.nx(),
                                         .rows = rows_.data(),
                                         .relative_inverse_mass = cloth_.relative_inverse_mass().data(),
                                         .built = &buffers[BufferId::built_position][0].x,
                                         .near = &buffers[BufferId::near_position][0].x,
                                         .bounds = buffers.words_of(BufferId::surface_bound).data(),
                                         .no_bound = shared::kInfinity,
                                         .with_lists = {b.x, b.y, b.z},
                                         .with_contacts = {n.x, n.y, n.z},
                                         .moved_squared_max = view_.moved_squared_max,
                                         .roam_max = view_.roam_max,
                                         .surface_limit = view_.surface_limit,
                                         .roam_share = shared::kRoamShare});
  std::vector<std::size_t> counts(threads);
  crew.run(threads, [&](std::uint32_t own) {
    LeashLook& look = looks[own];
    look.first = own * cloth_.rows() / threads;
    look.last = (own + std::size_t{1}) * cloth_.rows() / threads;
    look.left_over = left_over_.data() + look.first * cloth_.nx();
    counts[own] = kernels_.look_at_motion(look);
  });
  bool moved = false;
  for (std::uint32_t own = 0; own < threads; ++own) {
    stale |= looks[own].stale != 0;
    moved |= hold_back({looks[own].left_over, counts[own]}, buffers);
  }
  return moved;
}

/// With the mirror's own code: few are out of their room.
bool SelfCollision::hold_back(std::span<const std::uint32_t> particles, HostBuffers<float>& buffers) {
  const Leash<float> leash(view_, buffers);
  const std::size_t stride = cloth_.sheet().stride;
  for (const std::uint32_t p : particles) {
    const float* const at = rows_[p / cloth_.nx()] + kColumns + p % cloth_.nx();
    glm::vec3 x(at[0], at[stride], at[2 * stride]), v(at[3 * stride], at[4 * stride], at[5 * stride]);
    buffers.words_of(BufferId::collision_state)[shared::kHeldBack] += leash.keep(
        x, v, glm::vec3(buffers[BufferId::built_position][p]), glm::vec3(buffers[BufferId::near_position][p]),
        buffers.words_of(BufferId::surface_bound)[p]);
    cloth_.place(p, {x.x, x.y, x.z}, {v.x, v.y, v.z});
  }
  return !particles.empty();
}

/// Boxes of patches and who bends in them; where everybody is as the lists are made. Returns how many cells
/// are left over: whether they are creased is still to be seen.
std::size_t SelfCollision::look_at_patches(HostBuffers<float>& buffers, Crew& crew, std::uint32_t threads) {
  const PatchGrid patches(view_.grid);
  const std::size_t floats = patch_look_floats(cloth_.nx());
  scratch_.resize(std::max(scratch_.size(), threads * floats));
  std::vector<PatchLook> looks(threads, {.stride = cloth_.sheet().stride,
                                         .nx = cloth_.nx(),
                                         .ny = cloth_.ny(),
                                         .search_squared = view_.patch_search_squared,
                                         .flat_min = view_.flat_min,
                                         .smooth = smooth_for(view_)});
  creased_.resize(threads);
  crew.run(threads, [&](std::uint32_t own) {
    kernels_.write_places({.stride = cloth_.sheet().stride,
                           .nx = cloth_.nx(),
                           .first = own * cloth_.rows() / threads,
                           .last = (own + std::size_t{1}) * cloth_.rows() / threads,
                           .rows = rows_.data(),
                           .places = &buffers[BufferId::built_position][0].x});
    PatchLook& look = looks[own];
    look.scratch = scratch_.data() + own * floats;
    creased_[own].clear();
    look_at_rows(std::size_t{own} * patches.rows() / threads,
                 (own + std::size_t{1}) * patches.rows() / threads, look, buffers, creased_[own]);
  });
  auto& longest = buffers.words_of(BufferId::collision_state)[shared::kLongestEdge];
  std::size_t left_over = 0;
  for (std::uint32_t own = 0; own < threads; ++own) {
    longest = std::max(longest, looks[own].longest);
    for (const LeftOver& cells : creased_[own]) left_over += cells.cells.size();
  }
  return left_over;
}

void SelfCollision::box_blocks(HostBuffers<float>& buffers, Crew& crew, std::uint32_t threads) {
  const PatchGrid patches(view_.grid);
  std::vector<std::uint32_t> widest(threads);
  crew.run(threads, [&](std::uint32_t own) {
    const std::uint64_t count = patches.block_count();
    widest[own] = write_blocks(view_, patches, buffers, static_cast<std::uint32_t>(own * count / threads),
                               static_cast<std::uint32_t>((own + 1) * count / threads));
  });
  auto& state = buffers.words_of(BufferId::collision_state);
  state[shared::kWidestBlock] = std::max(state[shared::kWidestBlock], *std::ranges::max_element(widest));
}

void SelfCollision::count_cells(HostBuffers<float>& buffers, Crew& crew, std::uint32_t threads) {
  make_room_for_lists(view_.grid, buffers);
  look_at_patches(buffers, crew, threads);
  crew.run(threads, [&](std::uint32_t own) {
    const std::size_t particles = view_.grid.count();
    clear_lists(buffers, own * particles / threads, (own + std::size_t{1}) * particles / threads);
    for (const LeftOver& cells : creased_[own]) look_closely(cells, buffers);
  });
  box_blocks(buffers, crew, threads);
  count_blocks(view_, PatchGrid(view_.grid), buffers);
}

bool SelfCollision::make_empty_lists(HostBuffers<float>& buffers, Crew& crew, std::uint32_t threads,
                                     const std::function<void()>& need_positions) {
  auto& state = buffers.words_of(BufferId::collision_state);
  const bool were_empty =
      state[shared::kListsArmed] != 0 && state[shared::kPairsListed] == 0 && state[shared::kLookers] == 0;
  if (!were_empty || !lists_stale(buffers)) return false;
  make_room_for_lists(view_.grid, buffers);
  if (look_at_patches(buffers, crew, threads) > 0) {
    need_positions();
    for (const auto& of_thread : creased_)
      for (const LeftOver& cells : of_thread) look_closely(cells, buffers);
  }
  box_blocks(buffers, crew, threads);
  look_near(buffers, crew, threads);
  if (state[shared::kLookers] != 0) return false;
  count_lists(buffers);
  end_lists(buffers);
  if (watch_) watch_->lists_made();
  return true;
}

/// Rows of patches of all cloths, one cloth's after the other's: the kernel knows but one.
void SelfCollision::look_at_rows(std::size_t first, std::size_t last, PatchLook& look,
                                 HostBuffers<float>& buffers, std::vector<LeftOver>& left_over) {
  const PatchGrid patches(view_.grid);
  const std::size_t down = patches.ny();
  std::uint32_t longest = 0;
  for (std::size_t row = first; row < last;) {
    const std::size_t cloth = row / down, end = std::min(last, (cloth + 1) * down);
    const std::size_t patches_before = cloth * down * patches.nx();
    look.rows = rows_.data() + cloth * cloth_.ny();
    look.boxes = &buffers[BufferId::patches][2 * patches_before].x;
    look.first = row - cloth * down, look.last = end - cloth * down;
    look.left_over = left_over_.data() + 4 * row * patches.nx();
    const std::size_t count = kernels_.look_at_patches(look);
    longest = std::max(longest, look.longest);
    if (count > 0) left_over.push_back({{look.left_over, count}, static_cast<std::uint32_t>(patches_before)});
    row = end;
  }
  look.longest = longest;
}

/// Of cells that no three planes part, 4·patch + k each, counted in their cloth: those that are creased, with
/// the mirror's own code.
void SelfCollision::look_closely(const LeftOver& left_over, HostBuffers<float>& buffers) const {
  const PatchGrid patches(view_.grid);
  const std::span<const std::uint32_t> cells = left_over.cells;
  for (auto cell = cells.begin(); cell != cells.end();) {
    const std::uint32_t in_cloth = *cell / 4, patch = left_over.patches_before + in_cloth;
    const Folds<float> folds(view_, patches, buffers[BufferId::position], patch);
    bool creased = false;
    for (; cell != cells.end() && *cell / 4 == in_cloth; ++cell)
      creased = creased || folds.diagonal_in_reach(*cell % 4);
    if (creased) buffers[BufferId::patches][2 * std::size_t{patch} + 1].w += float{shared::kCreased};
  }
}

/// Calls act(y, patch, above) for the rows of patches of rows of leaves: which row of its cloth, its first
/// patch, and where in bends_ the row above begins.
template <class Act>
void SelfCollision::in_each_row_of(std::size_t first, std::size_t last, const Act& act) const {
  const PatchGrid patches(view_.grid);
  const std::size_t down = patches.ny(), across = patches.nx() + std::size_t{2};
  for (std::size_t leaves = first; leaves < last; ++leaves) {
    const std::size_t cloth = leaves / leaf_rows(), begin = 4 * (leaves % leaf_rows());
    for (std::size_t y = begin; y < std::min(begin + 4, down); ++y)
      act(y, (cloth * down + y) * patches.nx(), (cloth * (down + 2) + y) * across);
  }
}

void SelfCollision::look_near(HostBuffers<float>& buffers, Crew& crew, std::uint32_t threads) {
  const PatchGrid patches(view_.grid);
  const std::size_t nx = patches.nx(), leaves_down = levels_[0].down;
  const auto& boxes = buffers[BufferId::patches];
  auto& listed = buffers.words_of(BufferId::patch_listed);
  listed.resize(patches.count());
  const PatchSearch<float> search(view_, buffers);
  NearLook all{.nx = nx,
               .ny = patches.ny(),
               .leaf_rows = leaf_rows(),
               .boxes = &boxes[0].x,
               .inverse_cell = view_.inverse_cell,
               .cells_most = shared::kCellsFromOriginMax,
               .far_cells = search.cells_beyond(search.distance()),
               .distance = search.distance(),
               .cells_across = shared::kCellsAcrossMax,
               .overlooks = search.distance() <= view_.patch_search ? 0u : 1u,
               .looks_far = shared::kLooksFar,
               .level_count = levels_.size(),
               .listed = listed.data()};
  std::ranges::copy(levels_, all.levels);
  const auto part_of = [&](std::uint32_t own) {
    NearLook part = all;
    part.first = own * leaves_down / threads;
    part.last = (own + std::size_t{1}) * leaves_down / threads;
    return part;
  };
  crew.run(threads, [&](std::uint32_t own) {
    const NearLook part = part_of(own);
    kernels_.make_near_leaves(part);
    in_each_row_of(part.first, part.last, [&](std::size_t, std::size_t patch, std::size_t above) {
      for (std::size_t x = 0; x < nx; ++x)
        bends_[above + (nx + 2) + x + 1] = static_cast<std::uint8_t>(boxes[2 * (patch + x) + 1].w);
    });
  });
  kernels_.make_near_levels(all);
  crew.run(threads, [&](std::uint32_t own) {
    const NearLook part = part_of(own);
    in_each_row_of(part.first, part.last, [&](std::size_t y, std::size_t patch, std::size_t above) {
      for (std::size_t x = 0; x < nx; ++x) listed[patch + x] = looks_beside(x, y, &bends_[above + x]);
    });
    kernels_.look_near(part);
  });
  tell_lookers(view_, patches, buffers);
}

/// The bits of the particles that are at a folded cell; of all of them where a diagonal nearby is creased.
/// @param bends  of the patch above and to the left
std::uint32_t SelfCollision::looks_beside(std::size_t x, std::size_t y, const std::uint8_t* bends) const {
  const std::size_t across = (view_.grid.nx + std::size_t{1}) / 2 + 2;
  const std::uint8_t *const above = bends, *const own = above + across, *const below = own + across;
  const auto together = [](const std::uint8_t* row) { return std::uint32_t(row[0] | row[1] | row[2]); };
  const std::uint32_t round = together(above) | together(own) | together(below);
  if (round == 0) return 0;
  if ((round & shared::kCreased) != 0) return shared::kCreaseBeside | 15u * shared::kLooksBeside;
  // A patch's cells are numbered row by row; each particle is at four, of its own patch and those before it.
  const std::uint32_t here = own[1], left = own[0], up = above[1], corner = above[0];
  const std::uint32_t first = (here & 1u) | (left & 2u) | (up & 4u) | (corner & 8u);
  const std::uint32_t right = (here & 3u) | (up & 12u), down = (here & 5u) | (left & 10u), last = here & 15u;
  const bool has_right = 2 * x + 1 < view_.grid.nx, has_down = 2 * y + 1 < view_.grid.ny;
  const auto bit = [](std::uint32_t folded, std::uint32_t k) {
    return folded != 0 ? shared::kLooksBeside << k : 0u;
  };
  return bit(first, 0) | (has_right ? bit(right, 1) : 0u) | (has_down ? bit(down, 2) : 0u) |
         (has_right && has_down ? bit(last, 3) : 0u);
}

}  // namespace weft::native
