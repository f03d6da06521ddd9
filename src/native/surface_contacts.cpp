// Which thread looks at which part changes no bit: bounds are least distances, weights and kicks whole
// numbers that are added up.
#include "native/surface_contacts.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstdlib>

#include "passes/surface_response.h"

namespace weft::native {
namespace {

constexpr std::uint32_t kParticlesPerPart = 256;  // few enough that threads end together

void lower(std::uint32_t& place, std::uint32_t bits) {
  const std::atomic_ref<std::uint32_t> least(place);
  std::uint32_t now = least.load(std::memory_order_relaxed);
  while (bits < now && !least.compare_exchange_weak(now, bits, std::memory_order_relaxed)) {
  }
}

/// @param shared  whether other threads may add, too: a locked addition takes as long as ten others
void add(std::uint32_t& place, std::uint32_t units, bool shared) {
  if (shared)
    std::atomic_ref<std::uint32_t>(place).fetch_add(units, std::memory_order_relaxed);
  else
    place += units;
}

/// From a particle to its k-th neighbour, counted round and round.
std::int64_t way_round(const Grid& grid, std::size_t k) {
  const RingOffset off = kRingOffsets[k % kRingOffsets.size()];
  return std::int64_t{off.j} * grid.nx + off.i;
}

SurfacePair<float> pair_of(const SurfaceTouch& touch) {
  return {.particle = std::to_array(touch.particle),
          .weight = std::to_array(touch.weight),
          .edges = touch.edges != 0,
          .d = {touch.d[0], touch.d[1], touch.d[2]},
          .squared = touch.squared};
}

}  // namespace

void SurfaceContacts::Listed::add(const std::array<std::uint32_t, 4>& particles) {
  if (count % kColumns == 0) corners.resize(corners.size() + 4 * kColumns);  // zeros: the first particle
  std::uint32_t* const block = corners.data() + count / kColumns * (4 * kColumns) + count % kColumns;
  for (std::size_t m = 0; m < 4; ++m) block[m * kColumns] = particles[m];
  ++count;
}

template <class Act>
void SurfaceContacts::in_each_part(Crew& crew, std::uint32_t threads, const Act& act) {
  std::atomic<std::size_t> next = 0;
  crew.run(threads, [&](std::uint32_t) {
    for (std::size_t part = 0; (part = next.fetch_add(1, std::memory_order_relaxed)) < parts_.size();)
      act(part);
  });
}

/// Whose neighbours an entry names is there: it was listed.
void SurfaceContacts::take_apart(const HostBuffers<float>& buffers, std::size_t part) {
  Part& own = parts_[part];
  for (Listed* listed : {&own.triangles, &own.edges}) listed->corners.clear(), listed->count = 0;
  const auto& counts = buffers.words_of(BufferId::surface_count);
  const auto& entries = buffers.words_of(BufferId::surface_pairs);
  const std::size_t particles = view_.grid.count();
  const auto first = static_cast<std::uint32_t>(part * kParticlesPerPart);
  const auto last = static_cast<std::uint32_t>(std::min<std::size_t>(first + kParticlesPerPart, particles));
  const auto beside = [&](std::uint32_t p, std::size_t k) {
    return static_cast<std::uint32_t>(p + way_round(view_.grid, k));
  };
  for (std::uint32_t p = first; p < last; ++p)
    for (std::size_t k = 0; k < counts[p]; ++k) {
      const std::uint32_t entry = entries[k * particles + p], code = entry >> shared::kSurfaceCodeShift;
      const std::uint32_t other = view_.particle_at(entry & ((1u << shared::kSurfaceCodeShift) - 1));
      if (code < shared::kSurfaceTriangle) {
        own.edges.add({p, beside(p, code / 6), other, beside(other, code % 6)});
      } else {
        const std::size_t way = code - shared::kSurfaceTriangle;
        own.triangles.add({p, other, beside(other, way), beside(other, way + 1)});
      }
    }
}

/// @param shared  whether other parts are looked at at the same time
/// @return the bits of the part's smallest distance
std::uint32_t SurfaceContacts::look(std::size_t part, bool shared, HostBuffers<float>& buffers) {
  Part& own = parts_[part];
  own.touching.resize(own.triangles.count + own.edges.count);
  own.distances.resize(std::max(own.triangles.corners.size(), own.edges.corners.size()) / 4);
  own.touching_count = 0;
  auto& bounds = buffers.words_of(BufferId::surface_bound);
  std::uint32_t gap = shared::kInfinity;
  const auto look_at = [&](const Listed& listed, std::size_t (*kernel)(const SurfaceLook&)) {
    own.touching_count += kernel({.near = &buffers[BufferId::near_position][0].x,
                                  .corners = listed.corners.data(),
                                  .count = listed.count,
                                  .limit_squared = view_.surface_limit_squared,
                                  .edge_tiny = static_cast<float>(shared::kEdgeTiny_m2),
                                  .distances = own.distances.data(),
                                  .touching = own.touching.data() + own.touching_count});
    for (std::size_t k = 0; k < listed.count; ++k) {
      const auto bits = std::bit_cast<std::uint32_t>(own.distances[k]);
      gap = std::min(gap, bits);
      const std::uint32_t* const block = listed.corners.data() + k / kColumns * (4 * kColumns) + k % kColumns;
      for (std::size_t m = 0; m < 4; ++m) lower(bounds[block[m * kColumns]], bits);
    }
  };
  look_at(own.triangles, kernels_.look_at_triangles);
  look_at(own.edges, kernels_.look_at_edges);
  auto& touches = buffers.words_of(BufferId::touch_weight);
  for (std::size_t k = 0; k < own.touching_count; ++k)
    for (std::size_t m = 0; m < 4; ++m)
      add(touches[own.touching[k].particle[m]], touch_units(std::abs(own.touching[k].weight[m])), shared);
  return gap;
}

void SurfaceContacts::touch(HostBuffers<float>& buffers, Crew& crew, std::uint32_t threads) {
  if (!contacts_due(buffers)) return;
  if (!taken_apart_) {
    parts_.resize((view_.grid.count() + kParticlesPerPart - 1) / kParticlesPerPart);
    in_each_part(crew, threads, [&](std::size_t part) { take_apart(buffers, part); });
    taken_apart_ = true;
  }
  auto& state = buffers.words_of(BufferId::collision_state);
  state[shared::kContactGroups] = 0;
  in_each_part(crew, threads, [&](std::size_t part) {
    lower(state[shared::kSmallestGap], look(part, threads > 1, buffers));
  });
  const auto touches = [](const Part& part) { return part.touching_count > 0; };
  if (std::ranges::any_of(parts_, touches)) mark_touching(view_.grid, buffers);
}

void SurfaceContacts::respond(HostBuffers<float>& buffers, Crew& crew, std::uint32_t threads) {
  if (!touching_somewhere(buffers)) return;
  const SurfaceResponse<float> response(view_, buffers);
  auto& sums = buffers.words_of(BufferId::surface_sums);
  const auto give = [&](std::size_t place, std::uint32_t units) {
    if (units != 0) add(sums[place], units, threads > 1);
  };
  in_each_part(crew, threads, [&](std::size_t part) {
    for (std::size_t k = 0; k < parts_[part].touching_count; ++k)
      response.add(pair_of(parts_[part].touching[k]), give);
  });
}

std::uint64_t SurfaceContacts::bytes() const {
  std::uint64_t bytes = 0;
  for (const Part& part : parts_)
    bytes += (part.triangles.corners.size() + part.edges.corners.size()) * sizeof(std::uint32_t) +
             part.distances.size() * sizeof(float) + part.touching.size() * sizeof(SurfaceTouch);
  return bytes;
}

}  // namespace weft::native
