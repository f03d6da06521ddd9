// What the host computes for a plan's buffers on a device and reads back from them, in the plan's precision.
// The caller has waited for the simulation; pictures of it are waited for where what they show is written.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/gpu_program.h"
#include "sim/gpu_simulation.h"
#include "sim/perturb.h"

namespace weft {

using Bytes = std::vector<std::byte>;

/// work(0.0f), or work(0.0) where the plan computes in double.
template <class Work>
auto in_precision(const Plan& plan, Work&& work) {
  return plan.in_double() ? work(0.0) : work(0.0f);
}

/// A block that follows from the model alone.
/// @param id                  params, constraints, collision, moved_pins, strain_limits or tethers
/// @param energy_share_s2_m2  of the parameters (model/speed_budget.h)
Bytes block_bytes(BufferId id, const Model&, const Plan&, const Perturbation& = {},
                  double energy_share_s2_m2 = 0.0);

/// The substep table with these rows.
Bytes table_bytes(const Model&, const Plan&, std::span<const KickDrift> rows, const Perturbation& = {});

/// Writes a frame's rows into the slot's copy of the substep table, which no submitted work reads.
void write_table(GpuBuffers&, std::uint32_t slot, const Model&, const Plan&, std::span<const KickDrift> rows,
                 const Perturbation&);

/// The first words of a buffer that nothing under way writes.
template <std::size_t kCount>
std::array<std::uint32_t, kCount> read_words(const GpuBuffers& buffers, BufferId id) {
  std::array<std::uint32_t, kCount> words{};
  buffers.at(id).read_finished(std::as_writable_bytes(std::span(words)));
  return words;
}

/// Fills every copy of the blocks that the plan has.
void write_blocks(GpuBuffers&, const Model&, const Plan&, const Perturbation& = {});

/// Writes the words that self-collision's indirect dispatches take their workgroups from, as before anything
/// moves.
void write_groups(GpuBuffers&, const Model&);

/// Writes the canonical state: position, velocity, in f32k what rounding leaves over, and broken links with
/// the workgroups that follow from them.
void write_state(GpuBuffers&, Parity, const Model&, const Plan&, const State&);

/// @param time_s  that the state is to have
State read_state(const GpuBuffers&, Parity, const Model&, const Plan&, double time_s);

/// Writes what `energy_share_s2_m2` of the parameters is in the slot's frame.
void write_energy_share(GpuBuffers&, std::uint32_t slot, const Plan&, double energy_share_s2_m2);

/// The last sound state. @param time_s  that it is to have
State read_kept(const GpuBuffers&, const Model&, const Plan&, double time_s);

/// Puts pinned particles where they are to be; a run of consecutive indices is one write.
/// @throws Error(Exit::internal) when one of them is not pinned
void write_placed(GpuBuffers&, Parity, const Model&, const Plan&, std::span<const PlacedParticle>);

}  // namespace weft
