// The spring force by a sweep that evaluates each spring once, row by row, in the order of operations of
// docs/float-form.md. The shader gathers instead and evaluates each twice; both end in the same bits.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "passes/coefficients.h"

// Tells the compiler that a loop's arrays do not overlap, so that it vectorises without checks.
#if defined(__GNUC__) && !defined(__clang__)
#define WEFT_INDEPENDENT_ITERATIONS _Pragma("GCC ivdep")
#else
#define WEFT_INDEPENDENT_ITERATIONS
#endif

namespace weft {

/// One row of particles, component by component: x y z, then vx vy vz; each indexable from 0 to nx − 1.
template <class T>
using RowPointers = std::array<const T*, 6>;

/// Which springs a force has; what is off is left out of the sum.
struct ForceEffects {
  bool shear, two_apart, damping;  ///< two_apart: the (2,0) and (0,2) pairs, from flex springs or bending
};

/// K, L and c of each pair of one row; entry i belongs to the pair that is named by particle i.
template <class T>
struct CoefficientRow {
  std::vector<T> k, l, c;
  CoefficientRow() = default;
  explicit CoefficientRow(std::size_t n) : k(n), l(n), c(n) {}
  void set(std::size_t i, const glm::vec<4, T>& row) { k[i] = row.x, l[i] = row.y, c[i] = row.z; }
};

/// The coefficients spread along rows, so that the inner loops neither branch nor index tables.
template <class T>
struct SweepTables {
  std::array<CoefficientRow<T>, 2> structural_i;  ///< by whether the row is a boundary line
  std::array<CoefficientRow<T>, 3> structural_j;  ///< by the number of triples
  std::array<CoefficientRow<T>, 2> flex_i;
  CoefficientRow<T> flex_j, shear;
  std::size_t nx, ny;
  ForceEffects effects;

  SweepTables(const Grid& grid, const SpringRows<T>& rows, ForceEffects which)
      : flex_j(grid.nx), shear(grid.nx), nx(grid.nx), ny(grid.ny), effects(which) {
    for (auto& row : structural_i) row = CoefficientRow<T>(nx);
    for (auto& row : structural_j) row = CoefficientRow<T>(nx);
    for (auto& row : flex_i) row = CoefficientRow<T>(nx);
    for (std::size_t i = 0; i < nx; ++i) {
      const std::size_t boundary = i == 0 || i + 1 == nx ? 1 : 0;
      for (std::size_t line = 0; line < 2; ++line) {
        structural_i[line].set(i, rows.structural[line * 3 + triples_of(i, nx)]);
        flex_i[line].set(i, rows.flex[line]);
      }
      for (std::size_t t = 0; t < 3; ++t) structural_j[t].set(i, rows.structural[(2 + boundary) * 3 + t]);
      flex_j.set(i, rows.flex[2 + boundary]);
      shear.set(i, rows.shear);
    }
  }

  /// How many triples have the pair (place, place + 1) of a line as neighbours.
  static std::size_t triples_of(std::size_t place, std::size_t count) {
    return (place >= 1 ? 1u : 0u) + (place + 2 < count ? 1u : 0u);
  }
};

/// Force on the first particle of each of n pairs (a[i], b[i]); docs/float-form.md "One pair".
template <bool kDamped, class T>
void pair_forces(const RowPointers<T>& a, std::size_t a_shift, const RowPointers<T>& b, std::size_t b_shift,
                 const CoefficientRow<T>& row, std::size_t n, const std::array<T*, 3>& force) {
  const T* __restrict ax = a[0] + a_shift, * __restrict ay = a[1] + a_shift, * __restrict az = a[2] + a_shift;
  const T* __restrict bx = b[0] + b_shift, * __restrict by = b[1] + b_shift, * __restrict bz = b[2] + b_shift;
  const T* __restrict au = a[3] + a_shift, * __restrict av = a[4] + a_shift, * __restrict aw = a[5] + a_shift;
  const T* __restrict bu = b[3] + b_shift, * __restrict bv = b[4] + b_shift, * __restrict bw = b[5] + b_shift;
  const T* __restrict k = row.k.data(), * __restrict l = row.l.data(), * __restrict c = row.c.data();
  T* __restrict fx = force[0], * __restrict fy = force[1], * __restrict fz = force[2];
  constexpr T kTiny = static_cast<T>(1e-24);
  WEFT_INDEPENDENT_ITERATIONS
  for (std::size_t i = 0; i < n; ++i) {
    const T dx = bx[i] - ax[i], dy = by[i] - ay[i], dz = bz[i] - az[i];
    T q = (dx * dx + dy * dy) + dz * dz;
    q = q > kTiny ? q : kTiny;
    const T r = T(1) / std::sqrt(q);
    T s;
    if constexpr (kDamped) {
      const T du = bu[i] - au[i], dv = bv[i] - av[i], dw = bw[i] - aw[i];
      s = ((c[i] * ((dx * du + dy * dv) + dz * dw)) * r - l[i]) * r + k[i];
    } else {
      s = k[i] - l[i] * r;
    }
    fx[i] = s * dx;
    fy[i] = s * dy;
    fz[i] = s * dz;
  }
}

/// One thread's walk over a band of rows. Scratch rows have two zeros before and after the grid's, which
/// stand for the pairs that do not exist.
template <class T>
class ForceSweep {
 public:
  explicit ForceSweep(const SweepTables<T>& tables)
      : tables_(tables), stride_(tables.nx + 2 * kPad), arena_(3 * kForceRows * stride_, T(0)) {
    for (std::size_t r = 0; r < kForceRows; ++r)
      for (std::size_t d = 0; d < 3; ++d) rows_[r][d] = arena_.data() + (3 * r + d) * stride_ + kPad;
  }

  /// Calls emit(j, force) for each row j in [begin, end); force is three arrays of nx [N].
  /// load(j) returns row j's particles, which stay valid until row j + 3 is loaded.
  template <class Load, class Emit>
  void run(std::size_t begin, std::size_t end, Load&& load, Emit&& emit) {
    std::array<RowPointers<T>, 3> particles{};
    const std::size_t first = begin > 2 ? begin - 2 : 0;  // rows above, whose springs reach into the band
    const auto fetch = [&](std::size_t j) { return j < tables_.ny ? load(j) : RowPointers<T>{}; };
    particles[1] = fetch(first);
    particles[2] = fetch(first + 1);
    for (std::size_t j = first; j < end; ++j) {
      particles = {particles[1], particles[2], fetch(j + 2)};
      rotate_rows();
      if (tables_.effects.damping)
        evaluate_row<true>(j, particles);
      else
        evaluate_row<false>(j, particles);
      if (j < begin) continue;
      for (std::size_t d = 0; d < 3; ++d) sum_row(d);
      emit(j, std::as_const(rows_[kSum]));
    }
  }

 private:
  // Force rows: of this row, of the one above (…Above), and of the one two above.
  enum Row {
    k10,
    k20,
    k01,
    k01Above,
    kT,
    kTAbove,
    k11,
    k11Above,
    k02,
    k02Above,
    k02Above2,
    kSum,
    kForceRows
  };
  static constexpr std::size_t kPad = 2;

  void rotate_rows() {
    std::swap(rows_[k01], rows_[k01Above]);
    std::swap(rows_[kT], rows_[kTAbove]);
    std::swap(rows_[k11], rows_[k11Above]);
    std::swap(rows_[k02Above2], rows_[k02Above]);
    std::swap(rows_[k02Above], rows_[k02]);
  }

  void clear(Row row) {
    for (T* component : rows_[row]) std::fill_n(component, tables_.nx, T(0));
  }

  template <bool kDamped>
  void evaluate_row(std::size_t j, const std::array<RowPointers<T>, 3>& at) {
    const SweepTables<T>& t = tables_;
    const std::size_t nx = t.nx, boundary = j == 0 || j + 1 == t.ny ? 1 : 0;
    const bool below = j + 1 < t.ny, below2 = j + 2 < t.ny;
    pair_forces<kDamped>(at[0], 0, at[0], 1, t.structural_i[boundary], nx - 1, rows_[k10]);
    if (t.effects.two_apart && nx > 2)
      pair_forces<kDamped>(at[0], 0, at[0], 2, t.flex_i[boundary], nx - 2, rows_[k20]);
    if (below)
      pair_forces<kDamped>(at[0], 0, at[1], 0, t.structural_j[t.triples_of(j, t.ny)], nx, rows_[k01]);
    else
      clear(k01);
    if (t.effects.shear && below) {
      pair_forces<kDamped>(at[0], 0, at[1], 1, t.shear, nx - 1, rows_[k11]);
      pair_forces<kDamped>(at[0], 1, at[1], 0, t.shear, nx - 1, rows_[kT]);
    } else {
      clear(k11);
      clear(kT);
    }
    if (t.effects.two_apart && below2)
      pair_forces<kDamped>(at[0], 0, at[2], 0, t.flex_j, nx, rows_[k02]);
    else
      clear(k02);
  }

  /// docs/float-form.md "The sum at particle (i, j)", for component d.
  void sum_row(std::size_t d) {
    const T *f10 = rows_[k10][d], *f20 = rows_[k20][d], *f01 = rows_[k01][d], *f11 = rows_[k11][d];
    const T *f_t = rows_[kT][d], *f02 = rows_[k02][d], *f01_above = rows_[k01Above][d];
    const T *t_above = rows_[kTAbove][d], *f11_above = rows_[k11Above][d], *f02_above2 = rows_[k02Above2][d];
    T* __restrict sum = rows_[kSum][d];
    const auto nx = static_cast<std::ptrdiff_t>(tables_.nx);
    WEFT_INDEPENDENT_ITERATIONS
    for (std::ptrdiff_t i = 0; i < nx; ++i) {
      const T p = ((f02_above2[i] + f01_above[i]) + t_above[i]) + f11_above[i - 1];
      sum[i] =
          ((((((f01[i] - p) + f10[i]) + (f_t[i - 1] - f10[i - 1])) + f11[i]) + f20[i]) - f20[i - 2]) + f02[i];
    }
  }

  const SweepTables<T>& tables_;
  std::size_t stride_;
  std::vector<T> arena_;
  std::array<std::array<T*, 3>, kForceRows> rows_;
};

}  // namespace weft
