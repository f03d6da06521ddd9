// Spring rows with bending folded in (docs/float-form.md "Constants") and schedule rows, in double.
#include "passes/coefficients.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "model/distance_grid.h"
#include "model/motion.h"
#include "model/solids.h"
#include "passes/reach.h"
#include "shared/params.h"

namespace weft {
namespace {

/// K, L, c of one pair: `folded` is what bending adds to K alone.
glm::dvec4 pair_row(const SpringKind& kind, double weight, double folded) {
  const double k = weight * kind.stiffness_n_m;
  return {k + folded, k * kind.rest_m, weight * kind.damping_n_s_m, 0.0};
}

/// A path less deep than this share of the body's inner radius is a chord of one sliding round it.
constexpr double kChordDepth = 0.01;

/// And less deep than this share of a cell of a mesh's grid.
constexpr double kMeshChordDepth = 0.1;

/// Where a body that is at `start` and then at `end` is and moves during the row's drift.
SolidRow<double> moving_row(const SolidFrame& start, const SolidFrame& end, const KickDrift& row) {
  SolidRow<double> out{};
  out.center = end.center_m;
  out.start = start.center_m;
  if (row.drift_s > 0.0) {
    out.velocity = (end.center_m - start.center_m) / row.drift_s;
    out.spin = angular_velocity(start, end, row.drift_s);
  }
  for (int k = 0; k < 3; ++k) {
    out.axes[k] = end.axes[k];
    out.start_axes[k] = start.axes[k];
  }
  return out;
}

SolidRow<double> solid_row(const Model& model, const Solid& solid, const KickDrift& row) {
  SolidRow<double> out =
      moving_row(frame_at(solid, row.drift_time_s), frame_at(solid, row.drift_time_s + row.drift_s), row);
  out.half = solid.half_m;
  out.reach = solid.radius_m + model.half_thickness_m;
  out.deep = kChordDepth * (out.reach + std::min({out.half.x, out.half.y, out.half.z}));
  out.friction = solid.section->friction;
  return out;
}

SolidRow<double> mesh_row(const Model& model, std::size_t mesh, const KickDrift& row) {
  const MeshSection& section = model.scene.meshes[mesh];
  SolidRow<double> out =
      moving_row(frame_at(section, row.drift_time_s), frame_at(section, row.drift_time_s + row.drift_s), row);
  out.reach = model.half_thickness_m;
  out.deep = kMeshChordDepth * model.meshes[mesh]->cell_m;
  out.friction = section.friction;
  return out;
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
  SubstepRow<double> out{alpha * wind_at(scene, row.kick_time_s),
                         0.0,
                         row.kick_s,
                         row.drift_s,
                         row.predict_s,
                         0.0,
                         {},
                         {},
                         {},
                         {}};
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
    const PinSection& pin = scene.pins[p];
    const glm::dvec3 end = pin_offset_at(scene, pin, row.drift_time_s + row.drift_s);
    const glm::dvec3 travel = end - pin_offset_at(scene, pin, row.drift_time_s);
    out.pins.push_back({end, row.drift_s > 0.0 ? travel / row.drift_s : glm::dvec3(0.0),
                        has_released(pin, row.drift_time_s)});
  }
  for (const Solid& solid : solids_of(scene)) out.solids.push_back(solid_row(model, solid, row));
  for (std::size_t mesh = 0; mesh < model.meshes.size(); ++mesh)
    out.meshes.push_back(mesh_row(model, mesh, row));
  return out;
}

std::uint32_t solid_count(const Model& model) {
  return static_cast<std::uint32_t>(model.scene.capsules.size() + model.scene.boxes.size());
}

bool has_tilted_floor(const Model& model) { return model.scene.floor && !model.scene.floor->is_level(); }

TiltRow<double> tilt_row_exact(const Model& model) {
  const FloorPlane plane = floor_plane(*model.scene.floor);
  return {plane.normal, glm::dot(plane.normal, plane.point_m) + model.half_thickness_m};
}

bool has_wind_noise(const Scene& scene) { return scene.wind && scene.wind->noise_m_s > 0.0; }

AirRow<double> air_row_exact(const Model& model, const KickDrift& row) {
  const Scene& scene = model.scene;
  const double share = scene.aerodynamics->density_kg_m3 / 12.0;  // ½ of it, ½ of a cross product, a third
  AirRow<double> air{};
  air.wind = wind_at(scene, row.kick_time_s);
  air.drag = share * scene.aerodynamics->drag;
  air.lift = share * scene.aerodynamics->lift;
  if (!has_wind_noise(scene)) return air;
  const WindSection& wind = *scene.wind;
  // The eddies drift with the mean wind (Taylor's frozen turbulence) and change as they go.
  constexpr double kCells = shared::kNoisePeriodMask + 1.0;
  const glm::dvec3 drifted = wind.velocity_m_s * (row.kick_time_s / wind.noise_scale_m);
  for (int axis = 0; axis < 3; ++axis) air.origin[axis] = std::fmod(drifted[axis], kCells);
  const double slices = row.kick_time_s / wind.noise_period_s;
  air.slice = std::fmod(std::floor(slices), 0x1p20);
  air.slice_share = slices - std::floor(slices);
  air.slice_share *= air.slice_share * (3.0 - 2.0 * air.slice_share);
  air.cells_1_m = 1.0 / wind.noise_scale_m;
  air.noise_m_s = wind.noise_m_s;
  return air;
}

RowLayout row_layout(const Model& model) {
  RowLayout at{};
  at.pins = shared::kRowHeadVec4s +
            shared::kRowSphereVec4s * static_cast<std::uint32_t>(model.scene.spheres.size());
  at.solids = at.pins + shared::kRowPinVec4s * static_cast<std::uint32_t>(model.moved_pins.size());
  at.meshes = at.solids + shared::kRowSolidVec4s * solid_count(model);
  at.air = at.meshes + shared::kRowMeshVec4s * static_cast<std::uint32_t>(model.scene.meshes.size());
  at.floor = at.air + (model.scene.aerodynamics ? shared::kRowAirVec4s : 0);
  at.reach = at.floor + (has_tilted_floor(model) ? shared::kRowFloorVec4s : 0);
  at.stride = at.reach + (has_reach(model) ? shared::kRowReachVec4s : 0);
  return at;
}

}  // namespace weft
