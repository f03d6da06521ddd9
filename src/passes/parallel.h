// Splits rows of the grid over threads. Which thread does which band never changes a result: bands write
// disjoint rows and read only what nobody writes.
#pragma once
#include <cstdint>
#include <functional>

namespace weft {

/// Calls work(begin, end) on contiguous bands that cover [0, rows) once each, and returns when all are done.
/// Small grids run in the caller's thread. `work` must not throw and must not call parallel_rows.
/// @param items_per_row  how much a row weighs, in particles
void parallel_rows(std::uint32_t rows, std::uint64_t items_per_row,
                   const std::function<void(std::uint32_t, std::uint32_t)>& work);

}  // namespace weft
