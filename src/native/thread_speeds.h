// How many rows each thread sweeps: cores are not equally fast where a second hyperthread, another program or
// another machine shares some of them, and in bands of equal rows the slowest would hold up all.
#pragma once
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "native/cloth.h"

namespace weft::native {

inline constexpr std::uint32_t kRowsPerBandMin = 4;  ///< the first two and the last two are other rows

/// What a thread got done while it was timed.
struct ThreadWork {
  double rows = 0, busy_s = 0;
};

/// How fast the threads of a crew sweep, as far as it is known. One object serves all numbers of threads.
class ThreadSpeeds {
 public:
  /// @param known  by thread, relative; those not named 1
  explicit ThreadSpeeds(std::vector<double> known = {}) : speed_(std::move(known)) {}
  /// Takes in what threads 0 … n − 1 got done in the same time; no entry has busy_s of 0.
  void learn(std::span<const ThreadWork> work);
  /// Of thread 0 … count − 1, relative to each other; 1 where nothing is known.
  std::vector<double> of(std::uint32_t count) const;
  /// Another one each time that something is learnt.
  std::uint64_t version() const { return version_; }

 private:
  std::vector<double> speed_;  ///< by thread; 1 on average over those that learn() saw last
  std::uint64_t version_ = 0;
};

/// Where bands begin, by row of all cloths, and after them where the last one ends: rows in proportion to
/// `speeds`, at least kRowsPerBandMin wherever the cloth has that many a band. A border never parts one row
/// from the rest of its cloth, for a band reaches two rows into its neighbour.
std::vector<std::size_t> band_borders(const Cloth& cloth, std::span<const double> speeds);

}  // namespace weft::native
