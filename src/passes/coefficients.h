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

/// One pin with keys during one drift.
template <class T>
struct PinRow {
  glm::vec<3, T> offset;    ///< at the drift's end [m]
  glm::vec<3, T> velocity;  ///< the mean during the drift [m/s]
};

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
SubstepRow<T> substep_row(const Model& model, const KickDrift& kick_drift) {
  const SubstepRow<double> exact = substep_row_exact(model, kick_drift);
  SubstepRow<T> row{exact.alpha_wind,
                    static_cast<T>(exact.loss),
                    static_cast<T>(exact.gain),
                    static_cast<T>(exact.drift),
                    static_cast<T>(exact.predict_gain),
                    static_cast<T>(exact.predict_loss),
                    {},
                    {}};
  row.spheres.reserve(exact.spheres.size());
  for (const SphereRow<double>& s : exact.spheres)
    row.spheres.push_back(
        {s.center, s.travel, s.velocity, static_cast<T>(s.reach), static_cast<T>(s.friction)});
  for (const PinRow<double>& pin : exact.pins) row.pins.push_back({pin.offset, pin.velocity});
  return row;
}

}  // namespace weft
