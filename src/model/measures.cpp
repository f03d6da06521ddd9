// Energy, stretch, momentum, distances, penetration and the state's hash, in double on the host.
#include "model/measures.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>

#include "core/error.h"
#include "model/distance_grid.h"
#include "model/links.h"
#include "model/solids.h"
#include "model/springs.h"

namespace weft {
namespace {

bool finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// Calls visit(particle, mass [kg]) for every particle that is free at a time: pinned ones have no finite
/// mass.
template <class Visit>
void for_each_free(const Model& model, double time_s, Visit&& visit) {
  for (std::uint32_t p = 0; p < model.grid.count(); ++p)
    if (const double inverse = model.inverse_mass_at(p, time_s); inverse != 0.0)
      visit(p, model.interior_mass_kg / inverse);
}

std::uint64_t fnv1a(std::uint64_t hash, double value) {
  const auto rounded = static_cast<float>(value);
  const auto bits = std::bit_cast<std::uint32_t>(rounded == 0.0f ? 0.0f : rounded);  // −0 counts as +0
  for (int shift = 0; shift < 32; shift += 8) hash = (hash ^ ((bits >> shift) & 0xffu)) * 0x100000001b3ull;
  return hash;
}

}  // namespace

Energy energy(const Model& model, const State& state) {
  Energy sum;
  const glm::dvec3 gravity = model.scene.gravity ? model.scene.gravity->acceleration_m_s2 : glm::dvec3(0.0);
  for_each_free(model, state.time_s, [&](std::uint32_t p, double mass_kg) {
    sum.kinetic_j += 0.5 * mass_kg * glm::dot(state.velocity[p], state.velocity[p]);
    sum.gravity_j -= mass_kg * glm::dot(gravity, state.position[p]);
  });
  for_each_spring(model, [&](const SpringKind& kind, std::uint32_t a, std::uint32_t b, double weight) {
    if (is_broken(state.broken_links, model.grid, kind, a)) return;
    const double elongation_m = glm::distance(state.position[a], state.position[b]) - kind.rest_m;
    sum.elastic_j += 0.5 * weight * kind.stiffness_n_m * elongation_m * elongation_m;
  });
  for_each_triple(model, [&](std::uint32_t minus, std::uint32_t middle, std::uint32_t plus, double kappa) {
    if (!is_whole_triple(state.broken_links, minus, middle)) return;
    const glm::dvec3 bent = state.position[minus] - 2.0 * state.position[middle] + state.position[plus];
    sum.bending_j += 0.5 * kappa * glm::dot(bent, bent);
  });
  return sum;
}

Stretch stretch(const Model& model, const State& state) {
  std::vector<double> elongation;
  elongation.reserve(2 * std::size_t{model.grid.count()});
  for (const SpringName name : {kStructuralI, kStructuralJ}) {
    const SpringKind& kind = model.springs[name];
    for_each_join(model, kind, [&](std::uint32_t a, std::uint32_t b, double) {
      if (!is_broken(state.broken_links, model.grid, kind, a))
        elongation.push_back(glm::distance(state.position[a], state.position[b]) / kind.rest_m - 1.0);
    });
  }
  if (elongation.empty()) return {};
  if (!std::all_of(elongation.begin(), elongation.end(), [](double e) { return std::isfinite(e); })) {
    constexpr double kDiverged = std::numeric_limits<double>::infinity();
    return {kDiverged, kDiverged};  // sorting does not survive a NaN
  }
  const std::size_t rank = (99 * elongation.size() + 99) / 100 - 1;  // nearest rank: ⌈0.99 n⌉
  const auto p99 = elongation.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(elongation.begin(), p99, elongation.end());
  return {*std::max_element(p99, elongation.end()), *p99};
}

DampingRatios damping_ratios(const Model& model) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  DampingRatios ratios{kNone, 0.0};
  for (const SpringKind& kind : model.springs) {
    if (kind.stiffness_n_m <= 0.0) continue;
    const double ratio =
        kind.damping_n_s_m / (2.0 * std::sqrt(kind.stiffness_n_m * model.interior_mass_kg / 2.0));
    ratios = {std::min(ratios.least, ratio), std::max(ratios.largest, ratio)};
  }
  return ratios.least == kNone ? DampingRatios{kNone, kNone} : ratios;
}

glm::dvec3 linear_momentum(const Model& model, const State& state) {
  glm::dvec3 sum(0.0);
  for_each_free(model, state.time_s,
                [&](std::uint32_t p, double mass_kg) { sum += mass_kg * state.velocity[p]; });
  return sum;
}

glm::dvec3 angular_momentum(const Model& model, const State& state) {
  glm::dvec3 sum(0.0);
  for_each_free(model, state.time_s, [&](std::uint32_t p, double mass_kg) {
    sum += mass_kg * glm::cross(state.position[p], state.velocity[p]);
  });
  return sum;
}

double rms_distance(const State& a, const State& b) {
  WEFT_ASSERT(a.position.size() == b.position.size());
  if (a.position.empty()) return 0.0;
  double sum = 0.0;
  for (std::size_t p = 0; p < a.position.size(); ++p) {
    const glm::dvec3 d = a.position[p] - b.position[p];
    sum += glm::dot(d, d);
  }
  return std::sqrt(sum / static_cast<double>(a.position.size()));
}

double max_distance(const State& a, const State& b) {
  WEFT_ASSERT(a.position.size() == b.position.size());
  double largest = 0.0;
  for (std::size_t p = 0; p < a.position.size(); ++p) {
    const double d = glm::distance(a.position[p], b.position[p]);
    if (!(d <= largest)) largest = d;  // so that a NaN shows
  }
  return largest;
}

double deepest_penetration(const Model& model, const State& state) {
  double deepest_m = 0.0;
  const auto count = [&](double depth_m) {
    if (!(depth_m <= deepest_m)) deepest_m = depth_m;  // so that a NaN shows
  };
  const std::vector<Solid> solids = solids_of(model.scene);
  std::vector<SolidFrame> frames;
  frames.reserve(solids.size());
  for (const Solid& solid : solids) frames.push_back(frame_at(solid, state.time_s));
  for (const glm::dvec3& x : state.position) {
    if (model.scene.floor) count(model.half_thickness_m - floor_plane(*model.scene.floor).above_m(x));
    for (const SphereSection& sphere : model.scene.spheres) {
      const double reach_m = sphere.radius_m + model.half_thickness_m;
      count(reach_m - glm::distance(x, sphere_center_at(sphere, state.time_s)));
    }
    for (std::size_t k = 0; k < model.meshes.size(); ++k) {
      const SolidFrame frame = frame_at(model.scene.meshes[k], state.time_s);
      const glm::dvec3 own = glm::transpose(frame.axes) * (x - frame.center_m);
      count(model.half_thickness_m - distance_at(*model.meshes[k], own));
    }
    for (std::size_t k = 0; k < solids.size(); ++k)
      count(model.half_thickness_m - distance_from(solids[k], frames[k], x));
  }
  return deepest_m;
}

bool all_finite(const State& state, std::uint32_t* first_bad) {
  for (std::size_t p = 0; p < state.position.size(); ++p) {
    if (finite(state.position[p]) && finite(state.velocity[p])) continue;
    if (first_bad != nullptr) *first_bad = static_cast<std::uint32_t>(p);
    return false;
  }
  return true;
}

std::uint64_t state_hash(const State& state) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (std::size_t p = 0; p < state.position.size(); ++p) {
    for (const glm::dvec3& v : {state.position[p], state.velocity[p]}) {
      hash = fnv1a(hash, v.x);
      hash = fnv1a(hash, v.y);
      hash = fnv1a(hash, v.z);
    }
  }
  return hash;
}

}  // namespace weft
