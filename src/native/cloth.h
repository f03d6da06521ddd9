// What is simulated as the vector kernels hold it: rows of coordinates and deduplicated blocks of
// coefficients, cloth after cloth.
#pragma once
#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "model/model.h"
#include "native/blocks.h"
#include "passes/pass.h"

namespace weft::native {

/// Frees what was allocated for vectors.
struct AlignedDelete {
  void operator()(float* memory) const;
};

/// Zeroed floats at an address that is a multiple of 64.
using Floats = std::unique_ptr<float[], AlignedDelete>;
Floats make_floats(std::size_t count);

/// A frame's schedule as the kernels read it.
class KickTable {
 public:
  KickTable() = default;
  KickTable(const Model& model, std::span<const KickDrift> rows);
  std::span<const Kick> kicks() const { return kicks_; }

 private:
  std::vector<Sphere> spheres_;
  std::vector<Solid> solids_, meshes_;
  std::vector<PinPlace> pins_;
  std::vector<Air> air_;
  std::vector<Kick> kicks_;
};

/// Rows [first, last) of one of several cloths, counted within it. The kernels know but one cloth: they are
/// handed each with its own part of every array.
struct ClothRows {
  std::size_t cloth, first, last;
};

class Cloth {
 public:
  /// @param constants  of the plan's steps: which effects there are
  /// @param pad        columns to the right of the cloth, a multiple of kColumns
  /// @param looks_at_drifts  whether the sweep looks at them for bodies or links
  Cloth(const Model& model, std::span<const Constant> constants, std::size_t pad = kColumns,
        bool looks_at_drifts = false);

  const Sheet& sheet() const { return sheet_; }  ///< of the first cloth
  Sheet sheet_of(std::size_t cloth) const;
  const Outside& outside() const { return outside_; }
  std::uint32_t variant() const { return variant_; }  ///< SweepEffect bits
  std::size_t nx() const { return nx_; }
  std::size_t ny() const { return ny_; }      ///< rows of one cloth
  std::size_t rows() const { return rows_; }  ///< of all cloths
  std::size_t row_floats() const { return 6 * sheet_.stride; }
  /// Row j of the rows of all cloths.
  float* row(std::size_t j) { return state_.get() + padded_place(j) * row_floats(); }
  /// Each cloth's rows and the two that stay 0 after them: the k-th's begin at k·padded_ny().
  std::vector<float*> padded_rows();
  std::size_t padded_ny() const { return ny_ + 2; }
  /// Where row j of the rows of all cloths is among these.
  std::size_t padded_place(std::size_t j) const { return j / ny_ * padded_ny() + j % ny_; }
  /// Of rows [first, last) of all cloths, act(ClothRows) with those of each.
  template <class Act>
  void in_each_cloth(std::size_t first, std::size_t last, const Act& act) const {
    for (std::size_t at = first; at < last;) {
      const std::size_t begin = at / ny_ * ny_, end = std::min(last, begin + ny_);
      act(ClothRows{at / ny_, at - begin, end - begin});
      at = end;
    }
  }
  const std::vector<float>& relative_inverse_mass() const { return relative_inverse_mass_; }
  std::uint64_t bytes() const;
  std::size_t distinct_blocks() const { return blocks_.distinct(); }

  /// Takes positions and velocities of rows [first, last) of all cloths.
  void load(const HostBuffers<float>& buffers, std::size_t first, std::size_t last);
  /// Takes who is fixed and which links are broken; returns whether anything was otherwise.
  bool take_changes(const HostBuffers<float>& buffers);
  void set_relative_inverse_mass(std::uint32_t particle, float relative);
  /// Makes room for keep.
  void make_keep();
  /// Rows [first, last) of all cloths to where take_back finds them.
  void keep(std::size_t first, std::size_t last);
  void take_back(std::size_t first, std::size_t last);
  void place(std::uint32_t particle, const float (&x)[3], const float (&v)[3]);
  /// By particle; empty where nothing tears. Whoever breaks one says so to refresh_around.
  std::span<std::uint32_t> broken_links() { return broken_links_; }
  /// Coefficients anew where links of these particles have broken.
  void refresh_around(std::span<const std::uint32_t> particles);

 private:
  ClothChanges changes() const { return {relative_inverse_mass_, broken_links_}; }
  void point_at_blocks();
  std::size_t nx_, ny_, rows_;
  Sheet sheet_{};
  Outside outside_{};
  std::uint32_t variant_ = 0;
  Floats state_, kept_;
  std::vector<float> relative_inverse_mass_;
  std::vector<std::uint32_t> broken_links_;
  Blocks blocks_;
};

}  // namespace weft::native
