// The coefficients that a substep reads, each computed in double and rounded once to T: spring rows with
// folded bending, and the kick, drift, wind and sphere values of one row of the schedule.
#pragma once
#include <array>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "model/model.h"
#include "passes/pass.h"

namespace weft {

/// Spring coefficients in the layout that shared/params.h documents: x = K, y = L, z = c, w = 0.
template <class T>
struct SpringRows {
  std::array<glm::vec<4, T>, 12> structural;
  std::array<glm::vec<4, T>, 4> flex;
  glm::vec<4, T> shear;
};

/// The rows in double, before their one rounding.
SpringRows<double> spring_rows_exact(const Model& model);

/// One sphere during one drift.
template <class T>
struct SphereRow {
  glm::vec<3, T> center;    ///< at the drift's end [m]
  glm::vec<3, T> travel;    ///< during the drift [m]
  glm::vec<3, T> velocity;  ///< [m/s]
  T reach;                  ///< radius + half the cloth's thickness [m]
  T friction;
};

/// One pin that moves or lets go, during one drift.
template <class T>
struct PinRow {
  glm::vec<3, T> offset;    ///< at the drift's end [m]
  glm::vec<3, T> velocity;  ///< the mean during the drift [m/s]
  bool released = false;    ///< it has let go before the drift
};

/// One capsule or box during one drift.
template <class T>
struct SolidRow {
  glm::vec<3, T> center, start;           ///< of its middle, at the drift's end and start [m]
  glm::vec<3, T> velocity, spin;          ///< [m/s], [rad/s]; means of the drift
  glm::vec<3, T> half;                    ///< edges of the box inside the rounding [m]
  glm::vec<3, T> axes[3], start_axes[3];  ///< its own axes in the world, at the drift's end and start
  T reach;                                ///< radius of the rounding + half the cloth's thickness [m]
  T deep;                                 ///< a path that goes so deep is stopped at its entry [m]
  T friction;
};

/// A floor that is not level.
template <class T>
struct TiltRow {
  glm::vec<3, T> normal;
  T level;  ///< normal·x on the floor, half the cloth's thickness included [m]
};

/// What the air does during one kick.
template <class T>
struct AirRow {
  glm::vec<3, T> wind;    ///< [m/s], gusts included
  glm::vec<3, T> origin;  ///< of the noise's lattice [cells]
  T cells_1_m;            ///< 1/edge of a cell
  T slice, slice_share;   ///< of time: a whole number, and the share of the one after it
  T noise_m_s;            ///< amplitude
  T drag, lift;           ///< density/12 times the coefficient [kg/m³]
};

/// Where the parts of a row of the substep table begin, in real4s.
struct RowLayout {
  std::uint32_t pins, solids, meshes, air, floor, reach, stride;
};
RowLayout row_layout(const Model& model);

/// Capsules and boxes together.
std::uint32_t solid_count(const Model& model);
bool has_tilted_floor(const Model& model);
TiltRow<double> tilt_row_exact(const Model& model);

/// What [aerodynamics] reads of one row; the scene has the section.
AirRow<double> air_row_exact(const Model& model, const KickDrift& row);
bool has_wind_noise(const Scene& scene);

template <class T>
AirRow<T> air_row(const Model& model, const KickDrift& row) {
  const AirRow<double> exact = air_row_exact(model, row);
  const auto rounded = [](double value) { return static_cast<T>(value); };
  return {exact.wind,
          exact.origin,
          rounded(exact.cells_1_m),
          rounded(exact.slice),
          rounded(exact.slice_share),
          rounded(exact.noise_m_s),
          rounded(exact.drag),
          rounded(exact.lift)};
}

/// One row of the schedule as the integration pass reads it.
template <class T>
struct SubstepRow {
  glm::vec<3, T> alpha_wind;  ///< α·wind at the kick's time [m/s²]
  T loss;                     ///< 1 − e, e = exp(−α·kick); α itself where air is an ordinary force
  T gain;                     ///< φ = (1 − e)/α, or the kick's length without air [s]
  T drift;                    ///< the drift's length [s]
  T predict_gain;             ///< of the kick that predicts; 0 without one
  T predict_loss;             ///< 0 without one
  std::vector<SphereRow<T>> spheres;
  std::vector<PinRow<T>> pins;
  std::vector<SolidRow<T>> solids;
  std::vector<SolidRow<T>> meshes;  ///< reach is half the cloth's thickness
};

SubstepRow<double> substep_row_exact(const Model& model, const KickDrift& row);

/// α = drag/ρ [1/s]; 0 without air.
double drag_rate(const Model& model);

template <class T>
SpringRows<T> spring_rows(const Model& model) {
  const SpringRows<double> exact = spring_rows_exact(model);
  SpringRows<T> rows;
  for (std::size_t r = 0; r < exact.structural.size(); ++r) rows.structural[r] = exact.structural[r];
  for (std::size_t r = 0; r < exact.flex.size(); ++r) rows.flex[r] = exact.flex[r];
  rows.shear = exact.shear;
  return rows;
}

template <class T>
SolidRow<T> rounded(const SolidRow<double>& s) {
  return {s.center,
          s.start,
          s.velocity,
          s.spin,
          s.half,
          {glm::vec<3, T>(s.axes[0]), glm::vec<3, T>(s.axes[1]), glm::vec<3, T>(s.axes[2])},
          {glm::vec<3, T>(s.start_axes[0]), glm::vec<3, T>(s.start_axes[1]), glm::vec<3, T>(s.start_axes[2])},
          static_cast<T>(s.reach),
          static_cast<T>(s.deep),
          static_cast<T>(s.friction)};
}

template <class T>
SubstepRow<T> substep_row(const Model& model, const KickDrift& kick_drift) {
  const SubstepRow<double> exact = substep_row_exact(model, kick_drift);
  SubstepRow<T> row{exact.alpha_wind,
                    static_cast<T>(exact.loss),
                    static_cast<T>(exact.gain),
                    static_cast<T>(exact.drift),
                    static_cast<T>(exact.predict_gain),
                    static_cast<T>(exact.predict_loss),
                    {},
                    {},
                    {},
                    {}};
  row.spheres.reserve(exact.spheres.size());
  for (const SphereRow<double>& s : exact.spheres)
    row.spheres.push_back(
        {s.center, s.travel, s.velocity, static_cast<T>(s.reach), static_cast<T>(s.friction)});
  for (const PinRow<double>& pin : exact.pins) row.pins.push_back({pin.offset, pin.velocity, pin.released});
  for (const SolidRow<double>& solid : exact.solids) row.solids.push_back(rounded<T>(solid));
  for (const SolidRow<double>& mesh : exact.meshes) row.meshes.push_back(rounded<T>(mesh));
  return row;
}

}  // namespace weft
