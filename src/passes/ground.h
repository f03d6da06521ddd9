// The floor after the other contacts, level or tilted: docs/float-form.md "Contact".
#pragma once
#include "passes/solid.h"

namespace weft {

/// The floor after all other contact, so that it always holds.
template <class T>
struct Ground {
  FloorRow<T> level{};
  TiltRow<T> tilt{};
  bool has_level = false, has_tilt = false;

  explicit Ground(const Model& model) {
    if (!model.scene.floor) return;
    level = floor_row<T>(model);
    has_tilt = has_tilted_floor(model);
    has_level = !has_tilt;
    if (!has_tilt) return;
    const TiltRow<double> exact = tilt_row_exact(model);
    tilt = {exact.normal, static_cast<T>(exact.level)};
  }
  void touch(glm::vec<3, T>& x1, glm::vec<3, T>& v) const {
    if (has_level) floor_contact(level, x1, v);
    if (has_tilt) tilted_touch(tilt, level.friction, x1, v);
  }
};

}  // namespace weft
