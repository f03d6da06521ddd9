// On which side of a plane a point is, without rounding: the sign of a determinant as a sum of doubles that
// is exact. Source: Shewchuk 1997, Adaptive precision floating-point arithmetic and fast robust geometric
// predicates, sections 2.2 to 2.5.
#pragma once
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace weft::testing_support {

/// A number as a sum of at most so many doubles that do not overlap, ascending; none of them is 0.
class ExactSum {
 public:
  void add(double b) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < count_; ++k) {
      const double component = components_[k], sum = component + b, part = sum - component;
      const double lost = (component - (sum - part)) + (b - part);  // what rounding took
      if (lost != 0.0) components_[kept++] = lost;
      b = sum;
    }
    if (b != 0.0) components_[kept++] = b;
    count_ = kept;
  }
  /// x·y·z; nothing under- or overflows for coordinates in metres.
  void add_product(double x, double y, double z) {
    const double xy = x * y, error = std::fma(x, y, -xy);
    for (const double part : {error, xy}) {
      const double product = part * z;
      add(std::fma(part, z, -product));
      add(product);
    }
  }
  int sign() const { return count_ == 0 ? 0 : components_[count_ - 1] > 0.0 ? 1 : -1; }

 private:
  std::array<double, 128> components_;  // 24 products of four parts each
  std::size_t count_ = 0;
};

inline void add_determinant(ExactSum& sum, const glm::dvec3& x, const glm::dvec3& y, const glm::dvec3& z,
                            double s) {
  sum.add_product(s * x.x, y.y, z.z);
  sum.add_product(s * x.y, y.z, z.x);
  sum.add_product(s * x.z, y.x, z.y);
  sum.add_product(-s * x.z, y.y, z.x);
  sum.add_product(-s * x.x, y.z, z.y);
  sum.add_product(-s * x.y, y.x, z.z);
}

/// Whether a − b loses nothing, which is so for places that were floats and are not far apart in size.
inline bool is_exact_difference(const glm::dvec3& a, const glm::dvec3& b) {
  for (int axis = 0; axis < 3; ++axis) {
    const double difference = a[axis] - b[axis], part = a[axis] - difference;
    if ((a[axis] - (difference + part)) + (part - b[axis]) != 0.0) return false;
  }
  return true;
}

/// Sign of det[a−d, b−d, c−d]: on which side of the plane through a, b and c the point d is; 0: in it. Exact.
inline int side_of_plane_exact(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                               const glm::dvec3& d) {
  ExactSum sum;
  if (is_exact_difference(a, d) && is_exact_difference(b, d) && is_exact_difference(c, d)) {
    add_determinant(sum, a - d, b - d, c - d, 1.0);
    return sum.sign();
  }
  add_determinant(sum, a, b, c, 1.0);
  add_determinant(sum, b, c, d, -1.0);
  add_determinant(sum, a, c, d, 1.0);
  add_determinant(sum, a, b, d, -1.0);
  return sum.sign();
}

/// The same, without the exact sum where rounding cannot matter.
inline int side_of_plane(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
  const glm::dvec3 x = a - d, y = b - d, z = c - d;
  const double det = glm::dot(x, glm::cross(y, z));
  const auto size = [](const glm::dvec3& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); };
  if (std::abs(det) > 1e-14 * size(x) * size(y) * size(z)) return det > 0.0 ? 1 : -1;
  return side_of_plane_exact(a, b, c, d);
}

}  // namespace weft::testing_support
