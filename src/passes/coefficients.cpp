// Spring rows with bending folded in (docs/float-form.md "Constants") and schedule rows, in double.
#include "passes/coefficients.h"

#include <cmath>

#include "model/motion.h"

namespace weft {
namespace {

/// K, L, c of one pair: `folded` is what bending adds to K alone.
glm::dvec4 pair_row(const SpringKind& kind, double weight, double folded) {
  const double k = weight * kind.stiffness_n_m;
  return {k + folded, k * kind.rest_m, weight * kind.damping_n_s_m, 0.0};
}

}  // namespace

SpringRows<double> spring_rows_exact(const Model& model) {
  SpringRows<double> rows;
  for (std::size_t direction = 0; direction < 2; ++direction) {
    for (std::size_t boundary = 0; boundary < 2; ++boundary) {
      const double weight = boundary == 1 ? 0.5 : 1.0;
      const double kappa = weight * model.bend_kappa_n_m[direction];
      const std::size_t row = direction * 2 + boundary;
      for (std::size_t triples = 0; triples < 3; ++triples)
        rows.structural[row * 3 + triples] =
            pair_row(model.springs[kStructuralI + direction], weight, 2.0 * kappa * double(triples));
      rows.flex[row] = pair_row(model.springs[kFlexI + direction], weight, -kappa);
    }
  }
  rows.shear = pair_row(model.springs[kShearDown], 1.0, 0.0);
  return rows;
}

double drag_rate(const Model& model) {
  return model.scene.air ? model.scene.air->drag_kg_m2_s / model.scene.material.density_kg_m2 : 0.0;
}

SubstepRow<double> substep_row_exact(const Model& model, const KickDrift& row) {
  const Scene& scene = model.scene;
  const double alpha = drag_rate(model);
  SubstepRow<double> out{
      alpha * wind_at(scene, row.kick_time_s), 0.0, row.kick_s, row.drift_s, row.predict_s, 0.0, {}, {}};
  if (row.plain_air) {
    out.loss = alpha;
  } else if (alpha > 0.0) {  // 1 − e without cancellation
    out.loss = -std::expm1(-alpha * row.kick_s);
    out.gain = out.loss / alpha;
    out.predict_loss = -std::expm1(-alpha * row.predict_s);
    out.predict_gain = out.predict_loss / alpha;
  }
  for (const SphereSection& sphere : scene.spheres) {
    const glm::dvec3 end = sphere_center_at(sphere, row.drift_time_s + row.drift_s);
    const glm::dvec3 travel = end - sphere_center_at(sphere, row.drift_time_s);
    // A motion by keys may turn within a drift: the mean is what carries a particle from start to end.
    const glm::dvec3 velocity =
        sphere.keys.empty() || !(row.drift_s > 0.0) ? sphere.velocity_m_s : travel / row.drift_s;
    out.spheres.push_back({end, travel, velocity, sphere.radius_m + model.half_thickness_m, sphere.friction});
  }
  for (const std::uint32_t p : model.moved_pins) {
    const MotionKeys& keys = scene.pins[p].keys;
    const glm::dvec3 end = place_at(keys, row.drift_time_s + row.drift_s);
    const bool drifts = row.drift_s > 0.0;
    out.pins.push_back(
        {end, drifts ? (end - place_at(keys, row.drift_time_s)) / row.drift_s : glm::dvec3(0.0)});
  }
  return out;
}

}  // namespace weft
