// How many bytes each buffer of the dictionary takes, and which buffers a pass touches.
#pragma once
#include <cstdint>
#include <span>

#include "passes/pass.h"

namespace weft {

/// Frames whose tables may be in flight at once: each has its own copy of `params` and `substeps`, so that
/// writing the next frame's never races with the one that runs.
inline constexpr std::uint32_t kFrameSlots = 2;

/// Rows that one substep table has room for: the next power of two, so that small changes of n keep the
/// buffer.
/// @param rows  of a frame (Plan::row_count)
std::uint32_t substep_row_capacity(std::uint32_t rows);

/// vec4s from one row of the substep table to the next: its head, every collider and every pin that moves
/// (shared/params.h).
std::uint32_t substep_row_stride(const Model& model);

/// Bytes of one copy of a buffer for this model and number of rows a frame.
std::uint64_t slot_bytes(BufferId id, const Model& model, std::uint32_t rows, bool in_double = false);

/// Elements of one copy.
std::uint64_t element_count(BufferId id, const Model& model, std::uint32_t rows);

/// Whether the host writes the buffer, from the model and the schedule: mirrors compute what is in it.
bool host_written(BufferId id);

/// Copies there are of a buffer: kFrameSlots of what the host writes each frame, one of all else.
std::uint32_t slot_count(BufferId id);

/// The buffers a pass reads or writes, ascending, without the reach_groups that a
/// pass has in some plans only; its shader's SPIR-V says the same
/// (tests/sim holds them together).
std::span<const BufferId> buffers_of(const Pass& pass);

}  // namespace weft
