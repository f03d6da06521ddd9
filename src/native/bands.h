// The cloth's rows shared out to threads: each sweeps a band of its own and waits for its two neighbours
// alone.
#pragma once
#include <atomic>
#include <memory>
#include <span>
#include <vector>

#include "native/cloth.h"
#include "native/crew.h"

namespace weft::native {

inline constexpr std::uint32_t kRowsPerBandMin = 4;  ///< the first two and the last two are other rows

/// Where the b-th of so many bands begins, by row of all cloths; b = count: where the last one ends. A border
/// never parts one row from the rest of its cloth, for a band reaches two rows into its neighbour.
std::size_t band_border(const Cloth& cloth, std::size_t b, std::size_t count);

/// How the rows are divided, and what bands hand each other. A band hands on its outer two rows of each end
/// after every sweep, into one of two copies by turns: a neighbour reads one while the other is written, so
/// that nobody waits for a reader. Where one cloth ends and another begins nothing is handed on and nobody
/// waits; a band with rows of several cloths sweeps one after the other. No bit depends on the division.
class Bands {
 public:
  /// @param count  at most cloth.rows() / kRowsPerBandMin, at least 1
  /// @param half_velocity  velocity Verlet's, 3·stride a row; null in leapfrog
  Bands(Cloth& cloth, const Kernels& kernels, std::uint32_t count, float* half_velocity = nullptr);

  std::uint32_t count() const { return static_cast<std::uint32_t>(bands_.size()); }
  /// One sweep after the other, band by band in the crew's threads.
  void sweep(Crew& crew, std::span<const Kick> kicks);
  /// What is drawn, band by band. `wanted` names the outputs; its rows are set here.
  void surface(Crew& crew, const Surface& wanted);

 private:
  struct alignas(64) Band {
    std::vector<ClothRows> parts;                       ///< by cloth
    std::vector<float*> rows;                           ///< as Cloth::padded_rows
    std::size_t first = 0, last = 0;                    ///< places in these
    bool goes_on_above = false, goes_on_below = false;  ///< its outer cloths, in the neighbours
    Floats carried;
    Floats handed;                       ///< two copies of four rows
    std::atomic<std::uint32_t> done{0};  ///< states handed on since the sweeps began
  };
  void sweep_band(std::uint32_t own, std::span<const Kick> kicks);
  void sweep_rows(const Band& band, const Kick& kick);
  void take_neighbours(std::uint32_t own, std::size_t copy);
  void hand_on(Band& band, std::size_t copy);
  float* handed_row(const Band& band, std::size_t copy, std::size_t row) const;

  Cloth& cloth_;
  const Kernels& kernels_;
  float* half_velocity_;
  std::vector<std::unique_ptr<Band>> bands_;
};

}  // namespace weft::native
