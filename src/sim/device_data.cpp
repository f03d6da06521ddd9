// What the host computes for a plan's buffers and reads back from them, in the plan's precision.
#include "sim/device_data.h"

#include <cstddef>
#include <cstring>
#include <utility>

#include "core/error.h"
#include "passes/collision.h"
#include "passes/mesh_grids.h"
#include "passes/moved_pins.h"
#include "passes/reach.h"
#include "passes/strain_limit.h"
#include "passes/tables.h"
#include "passes/xpbd.h"
#include "passes/xpbd_tethers.h"

namespace weft {
namespace {

template <class T>
Bytes bytes_of(std::span<const T> values) {
  const auto bytes = std::as_bytes(values);
  return {bytes.begin(), bytes.end()};
}

std::vector<BufferId> state_buffers(const GpuBuffers& buffers) {
  std::vector<BufferId> ids{BufferId::position, BufferId::velocity};
  for (const BufferId id : {BufferId::compensation, BufferId::broken_links})
    if (buffers.has(id)) ids.push_back(id);
  return ids;
}

template <class T>
HostBuffers<T> sized_for_state(const GpuBuffers& buffers, const Model& model, const Plan& plan) {
  HostBuffers<T> host;
  for (const BufferId id : state_buffers(buffers)) {
    const std::uint64_t count = element_count(id, model, plan.row_count());
    holds_words(id) ? host.words_of(id).resize(count) : host[id].resize(count);
  }
  return host;
}

template <class T>
std::span<std::byte> bytes_in(HostBuffers<T>& host, BufferId id) {
  return holds_words(id) ? std::as_writable_bytes(std::span(host.words_of(id)))
                         : std::as_writable_bytes(std::span(host[id]));
}

}  // namespace

Bytes block_bytes(BufferId id, const Model& model, const Plan& plan, const Perturbation& perturbation,
                  double energy_share_s2_m2) {
  return in_precision(plan, [&]<class T>(T) -> Bytes {
    if (id == BufferId::collision) {
      const auto collision = make_collision<T>(model);
      return bytes_of(std::span(&collision, 1));
    }
    if (id == BufferId::distance_grids) {
      const auto words = make_distance_words(model);
      return bytes_of(std::span<const std::uint32_t>(words));
    }
    if (id == BufferId::moved_pins) {
      const auto pins = make_moved_pins<T>(model);
      return bytes_of(std::span<const shared::MovedPinOf<T>>(pins));
    }
    if (id == BufferId::tethers) {
      const auto tethers = make_tethers<T>(model);
      return bytes_of(std::span<const shared::TetherOf<T>>(tethers));
    }
    if (id == BufferId::strain_limits) {
      const auto limits = strain_limit_rows<T>(model);
      return bytes_of(std::span<const glm::vec<4, T>>(limits));
    }
    if (id == BufferId::constraints) {
      ConstraintRows<T> constraints = constraint_rows<T>(model);
      perturbation.apply(constraints);
      const std::size_t count = element_count(id, model, plan.row_count());
      return bytes_of(std::span<const glm::vec<4, T>>(constraints).first(count));
    }
    WEFT_ASSERT(id == BufferId::params);
    auto params = make_params<T>(model, energy_share_s2_m2);
    perturbation.apply(model, params);
    return bytes_of(std::span<const shared::ParamsOf<T>>(&params, 1));
  });
}

Bytes table_bytes(const Model& model, const Plan& plan, std::span<const KickDrift> rows,
                  const Perturbation& perturbation) {
  return in_precision(plan, [&]<class T>(T) {
    std::vector<glm::vec<4, T>> table;
    fill_substep_rows(model, rows, table);
    perturbation.apply(model, std::span(table));
    return bytes_of(std::span<const glm::vec<4, T>>(table));
  });
}

void write_table(GpuBuffers& buffers, std::uint32_t slot, const Model& model, const Plan& plan,
                 std::span<const KickDrift> rows, const Perturbation& perturbation) {
  const Bytes table = table_bytes(model, plan, rows, perturbation);
  gpu::Buffer& buffer = buffers.at(BufferId::substeps, slot);
  if (table.size() > buffer.bytes())
    throw error(Exit::internal, "a frame has {} rows; the plan of {} substeps has room for {}", rows.size(),
                plan.substeps, substep_row_capacity(plan.row_count()));
  buffer.write_unused(table);
}

void write_blocks(GpuBuffers& buffers, const Model& model, const Plan& plan,
                  const Perturbation& perturbation) {
  for (const BufferId id :
       {BufferId::params, BufferId::constraints, BufferId::collision, BufferId::moved_pins,
        BufferId::strain_limits, BufferId::distance_grids, BufferId::tethers}) {
    if (!buffers.has(id)) continue;
    const Bytes bytes = block_bytes(id, model, plan, perturbation);
    for (std::uint32_t slot = 0; slot < slot_count(id); ++slot) buffers.at(id, slot).write_unused(bytes);
  }
}

void write_groups(GpuBuffers& buffers, const Model& model) {
  if (!buffers.has(BufferId::collision_state)) return;
  const std::vector<std::uint32_t> words = initial_collision_state(model);
  buffers.at(BufferId::collision_state).write_unused(std::as_bytes(std::span(words)));
}

void write_state(GpuBuffers& buffers, Parity parity, const Model& model, const Plan& plan,
                 const State& state) {
  in_precision(plan, [&]<class T>(T) {
    auto host = sized_for_state<T>(buffers, model, plan);
    auto& groups = host.words_of(BufferId::reach_groups);
    if (buffers.has(BufferId::reach_groups)) groups = initial_reach_groups(model, plan.reaching.links);
    load_state(model, state, host);
    for (const BufferId id : state_buffers(buffers))
      buffers.at(at_parity(id, parity)).write(bytes_in(host, id));
    if (!groups.empty()) buffers.at(BufferId::reach_groups).write(std::as_bytes(std::span(groups)));
  });
}

State read_state(const GpuBuffers& buffers, Parity parity, const Model& model, const Plan& plan,
                 double time_s) {
  return in_precision(plan, [&]<class T>(T) {
    auto host = sized_for_state<T>(buffers, model, plan);
    for (const BufferId id : state_buffers(buffers))
      buffers.at(at_parity(id, parity)).read_finished(bytes_in(host, id));
    return store_state(host, time_s);
  });
}

void write_energy_share(GpuBuffers& buffers, std::uint32_t slot, const Plan& plan,
                        double energy_share_s2_m2) {
  in_precision(plan, [&]<class T>(T) {
    const T share = static_cast<T>(energy_share_s2_m2);
    buffers.at(BufferId::params, slot)
        .write_unused(std::as_bytes(std::span(&share, 1)), offsetof(shared::ParamsOf<T>, energy_share_s2_m2));
  });
}

State read_kept(const GpuBuffers& buffers, const Model& model, const Plan& plan, double time_s) {
  return in_precision(plan, [&]<class T>(T) {
    HostBuffers<T> kept;
    for (const auto& [from, to] : {std::pair{BufferId::kept_position, BufferId::position},
                                   std::pair{BufferId::kept_velocity, BufferId::velocity}}) {
      kept[to].resize(model.grid.count());
      buffers.at(from).read_finished(std::as_writable_bytes(std::span(kept[to])));
    }
    if (buffers.has(BufferId::broken_links)) {  // torn since is torn
      kept.words_of(BufferId::broken_links).resize(model.grid.count());
      buffers.at(BufferId::broken_links).read_finished(bytes_in(kept, BufferId::broken_links));
    }
    return store_state(kept, time_s);
  });
}

void write_placed(GpuBuffers& buffers, Parity parity, const Model& model, const Plan& plan,
                  std::span<const PlacedParticle> particles) {
  require_pinned(model, particles);
  in_precision(plan, [&]<class T>(T) {
    using Element = glm::vec<4, T>;
    for (std::size_t first = 0; first < particles.size();) {
      std::vector<Element> positions, velocities;
      std::size_t next = first;
      while (next < particles.size() &&
             particles[next].particle == particles[first].particle + (next - first)) {
        positions.emplace_back(glm::vec<3, T>(particles[next].position_m), T(0));
        velocities.emplace_back(glm::vec<3, T>(particles[next].velocity_m_s), T(0));
        ++next;
      }
      const VkDeviceSize offset = particles[first].particle * sizeof(Element);
      buffers.at(at_parity(BufferId::position, parity)).write(std::as_bytes(std::span(positions)), offset);
      buffers.at(at_parity(BufferId::velocity, parity)).write(std::as_bytes(std::span(velocities)), offset);
      first = next;
    }
  });
}

}  // namespace weft
