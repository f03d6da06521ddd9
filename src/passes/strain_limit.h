// The limits that strain_limit reads.
#pragma once
#include <array>

#include "model/model.h"
#include "shared/params.h"

namespace weft {

/// Whether the scene has one.
inline bool has_strain_limit(const Model& model) { return model.scene.material.strain_limit > 0.0; }

/// The strain that limits a link: where it is pulled back, or where it breaks (never both).
inline double limiting_strain(const Model& model) {
  return model.scene.tearing ? model.scene.tearing->strain : model.scene.material.strain_limit;
}

/// The buffer strain_limits: lengths and squares in double, each rounded once.
template <class T>
std::array<glm::vec<4, T>, shared::kLimitRows> strain_limit_rows(const Model& model) {
  const auto row = [&](SpringName name) {
    const double longest_m = (1.0 + limiting_strain(model)) * model.springs[name].rest_m;
    return glm::vec<4, T>(static_cast<T>(longest_m), static_cast<T>(longest_m * longest_m), T(0), T(0));
  };
  return {row(kStructuralI), row(kShearDown)};
}

}  // namespace weft
