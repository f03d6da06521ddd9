// Trust-region Newton on the energy of springs, bending and gravity; matrix-free, double precision.
#include "study/equilibrium.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "core/error.h"
#include "model/measures.h"
#include "model/springs.h"

namespace weft::study {
namespace {

using Vectors = std::vector<glm::dvec3>;

constexpr std::uint32_t kIterationsMax = 400;
constexpr std::uint32_t kProductsMax = 30000;  // of the Hessian with a vector, in all
constexpr double kTinyLength_m = 1e-12;

double dot(const Vectors& a, const Vectors& b) {
  double sum = 0.0;
  for (std::size_t p = 0; p < a.size(); ++p) sum += glm::dot(a[p], b[p]);
  return sum;
}

void add_scaled(Vectors& a, double scale, const Vectors& b) {
  for (std::size_t p = 0; p < a.size(); ++p) a[p] += scale * b[p];
}

/// The energy as a function of positions: its value, gradient, and second derivative times a vector. Pinned
/// particles have no gradient.
class Landscape {
 public:
  explicit Landscape(const Model& model) : model_(model), free_(model.grid.count()) {
    for (std::size_t p = 0; p < free_.size(); ++p) free_[p] = model.relative_inverse_mass[p] != 0.0;
    for_each_spring(model, [&](const SpringKind& kind, std::uint32_t a, std::uint32_t b, double weight) {
      springs_.push_back({a, b, weight * kind.stiffness_n_m, kind.rest_m});
    });
    for_each_triple(model, [&](std::uint32_t minus, std::uint32_t middle, std::uint32_t plus, double kappa) {
      triples_.push_back({minus, middle, plus, kappa});
    });
  }

  double value(const Vectors& x) const {
    State state;
    state.position = x;
    state.velocity.assign(x.size(), glm::dvec3(0.0));
    return energy(model_, state).total();
  }

  Vectors gradient(const Vectors& x) const {
    Vectors g(x.size(), glm::dvec3(0.0));
    const glm::dvec3 gravity =
        model_.scene.gravity ? model_.scene.gravity->acceleration_m_s2 : glm::dvec3(0.0);
    for (std::uint32_t p = 0; p < x.size(); ++p)
      if (free_[p]) g[p] = -gravity * (model_.interior_mass_kg / model_.relative_inverse_mass[p]);
    for (const Spring& s : springs_) {
      const glm::dvec3 d = x[s.b] - x[s.a];
      const double length_m = std::max(glm::length(d), kTinyLength_m);
      const glm::dvec3 f = s.k * (1.0 - s.rest_m / length_m) * d;
      g[s.a] -= f;
      g[s.b] += f;
    }
    for (const Triple& t : triples_) {
      const glm::dvec3 f = t.kappa * (x[t.minus] - 2.0 * x[t.middle] + x[t.plus]);
      g[t.minus] += f;
      g[t.middle] -= 2.0 * f;
      g[t.plus] += f;
    }
    hold_pins(g);
    return g;
  }

  /// Prepares times() and precondition() at x.
  void move_to(const Vectors& x) {
    directions_.resize(springs_.size());
    blocks_.assign(x.size(), glm::dmat3(0.0));
    for (std::size_t s = 0; s < springs_.size(); ++s) {
      const glm::dvec3 d = x[springs_[s].b] - x[springs_[s].a];
      const double length_m = std::max(glm::length(d), kTinyLength_m);
      directions_[s] = {d / length_m, 1.0 - springs_[s].rest_m / length_m};
      const double across = std::max(0.0, directions_[s].across);  // keeps the blocks positive
      const glm::dmat3 block =
          springs_[s].k * (glm::dmat3(across) +
                           (1.0 - across) * glm::outerProduct(directions_[s].along, directions_[s].along));
      blocks_[springs_[s].a] += block;
      blocks_[springs_[s].b] += block;
    }
    for (const Triple& t : triples_) {
      blocks_[t.minus] += glm::dmat3(t.kappa);
      blocks_[t.middle] += glm::dmat3(4.0 * t.kappa);
      blocks_[t.plus] += glm::dmat3(t.kappa);
    }
    for (glm::dmat3& block : blocks_) {
      const double trace = block[0][0] + block[1][1] + block[2][2];
      block = trace > 0.0 ? glm::inverse(block + glm::dmat3(1e-6 * trace)) : glm::dmat3(1.0);
    }
  }

  Vectors times(const Vectors& v) const {
    Vectors out(v.size(), glm::dvec3(0.0));
    for (std::size_t s = 0; s < springs_.size(); ++s) {
      const Spring& spring = springs_[s];
      const Direction& at = directions_[s];
      const glm::dvec3 dv = v[spring.b] - v[spring.a];
      const glm::dvec3 along = at.along * glm::dot(at.along, dv);
      const glm::dvec3 f = spring.k * (along + at.across * (dv - along));
      out[spring.a] -= f;
      out[spring.b] += f;
    }
    for (const Triple& t : triples_) {
      const glm::dvec3 f = t.kappa * (v[t.minus] - 2.0 * v[t.middle] + v[t.plus]);
      out[t.minus] += f;
      out[t.middle] -= 2.0 * f;
      out[t.plus] += f;
    }
    hold_pins(out);
    return out;
  }

  Vectors precondition(const Vectors& r) const {
    Vectors z(r.size());
    for (std::size_t p = 0; p < r.size(); ++p) z[p] = blocks_[p] * r[p];
    hold_pins(z);
    return z;
  }

  static double largest(const Vectors& g) {
    double most = 0.0;
    for (const glm::dvec3& f : g) most = std::max(most, glm::length(f));
    return most;
  }

 private:
  struct Spring {
    std::uint32_t a, b;
    double k, rest_m;
  };
  struct Triple {
    std::uint32_t minus, middle, plus;
    double kappa;
  };
  struct Direction {
    glm::dvec3 along;
    double across;  ///< 1 − rest/length: stiffness across the spring, as a share of k
  };
  void hold_pins(Vectors& v) const {
    for (std::size_t p = 0; p < v.size(); ++p)
      if (!free_[p]) v[p] = glm::dvec3(0.0);
  }

  const Model& model_;
  std::vector<bool> free_;
  std::vector<Spring> springs_;
  std::vector<Triple> triples_;
  std::vector<Direction> directions_;
  std::vector<glm::dmat3> blocks_;
};

struct Step {
  Vectors move;
  double predicted_j = 0;  ///< change of the quadratic model's energy
  std::uint32_t products = 0;
  bool at_edge = false;
};

/// How far along `direction` from `move` the sphere of `radius` is.
double to_edge(const Vectors& move, const Vectors& direction, double radius) {
  const double a = dot(direction, direction), b = dot(move, direction), c = dot(move, move) - radius * radius;
  return (-b + std::sqrt(std::max(0.0, b * b - a * c))) / a;
}

/// Conjugate gradients on H·move = −g until the residual falls to `share` of the force, the curvature turns
/// negative or the trust region ends.
Step newton_step(const Landscape& landscape, const Vectors& g, double radius, double share,
                 const Stop& stop) {
  Step step;
  step.move.assign(g.size(), glm::dvec3(0.0));
  Vectors residual = g;
  Vectors z = landscape.precondition(residual);
  Vectors direction(g.size(), glm::dvec3(0.0));
  add_scaled(direction, -1.0, z);
  double rz = dot(residual, z);
  const double goal = share * share * dot(g, g);
  while (dot(residual, residual) > goal && step.products < 3 * g.size()) {
    if (stop && stop()) throw Error(Exit::interrupted, "interrupted");
    const Vectors curved = landscape.times(direction);
    ++step.products;
    const double curvature = dot(direction, curved);
    double length = curvature > 0.0 ? rz / curvature : 0.0;
    Vectors next = step.move;
    add_scaled(next, length, direction);
    step.at_edge = curvature <= 0.0 || dot(next, next) >= radius * radius;
    if (step.at_edge) length = to_edge(step.move, direction, radius);
    const double slope = dot(residual, direction);
    step.predicted_j += length * slope + 0.5 * length * length * curvature;
    add_scaled(step.move, length, direction);
    if (step.at_edge) break;
    add_scaled(residual, length, curved);
    z = landscape.precondition(residual);
    const double rz_next = dot(residual, z), carry = rz_next / rz;
    rz = rz_next;
    for (std::size_t p = 0; p < direction.size(); ++p) direction[p] = carry * direction[p] - z[p];
  }
  return step;
}

/// Why the scene can have no rest, before anything is computed; empty when it may.
std::string no_rest(const Model& model) {
  if (model.scene.wind && (model.scene.air || model.scene.aerodynamics)) return "it hangs in a wind";
  for (const double w : model.relative_inverse_mass)
    if (w == 0.0) return "";
  return "nothing is pinned";
}

class Descent {
 public:
  Descent(const Model& model, const State& start)
      : landscape_(model), x_(start.position), g_(landscape_.gradient(x_)), value_j_(landscape_.value(x_)) {}

  bool at_rest() const { return Landscape::largest(g_) <= kRestForce_n; }
  bool spent() const { return iterations_ >= kIterationsMax || products_ >= kProductsMax || radius_ < 1e-15; }
  double residual_n() const { return Landscape::largest(g_); }
  std::uint32_t iterations() const { return iterations_; }
  const Vectors& position() const { return x_; }

  void iterate(const Stop& stop) {
    ++iterations_;
    landscape_.move_to(x_);
    const double norm = std::sqrt(dot(g_, g_));
    const Step step = newton_step(landscape_, g_, radius_, std::min(0.1, std::sqrt(norm)), stop);
    products_ += step.products + 2;
    Vectors next = x_;
    add_scaled(next, 1.0, step.move);
    const double next_j = landscape_.value(next);
    Vectors next_g = landscape_.gradient(next);
    const double next_norm = std::sqrt(dot(next_g, next_g));
    // Close to rest the energy changes by less than its last bit; then the force decides.
    const bool blind = std::abs(step.predicted_j) < 1e-12 * std::max(1e-3, std::abs(value_j_));
    const double gain = blind ? (next_norm < norm ? 1.0 : 0.0) : (next_j - value_j_) / step.predicted_j;
    if (gain < 0.25) radius_ = 0.25 * std::min(radius_, std::sqrt(dot(step.move, step.move)));
    if (gain > 0.75 && step.at_edge) radius_ *= 2.0;
    if (!(gain > 1e-4)) return;
    x_ = std::move(next);
    g_ = std::move(next_g);
    value_j_ = next_j;
  }

 private:
  Landscape landscape_;
  Vectors x_, g_;
  double value_j_, radius_ = 0.1;
  std::uint32_t iterations_ = 0, products_ = 0;
};

}  // namespace

Equilibrium find_equilibrium(const Model& model, const State& start, const Stop& stop) {
  Equilibrium rest;
  rest.reason = no_rest(model);
  if (!rest.reason.empty()) return rest;
  Descent descent(model, start);
  while (!descent.at_rest() && !descent.spent()) descent.iterate(stop);
  rest.residual_n = descent.residual_n();
  rest.iterations = descent.iterations();
  if (!descent.at_rest()) {
    rest.reason = fmt::format("not found: a force of {:.1e} N is left after {} Newton steps", rest.residual_n,
                              rest.iterations);
    return rest;
  }
  State state;
  state.position = descent.position();
  if (deepest_penetration(model, state) > 0.0)
    rest.reason = "its rest would touch a collider";
  else
    rest.position = descent.position();
  return rest;
}

}  // namespace weft::study
