// Contact with capsules, boxes and meshes within the sweep: what its vectors leave over, with the mirrors'
// code.
#pragma once
#include <cstddef>
#include <memory>
#include <vector>

#include "model/model.h"
#include "native/kernel.h"
#include "passes/ground.h"
#include "plan/plan.h"

namespace weft::native {

/// A body's row of the schedule as mirrors know it.
SolidRow<float> solid_row_of(const Solid& solid);

/// Whether contact with bodies is the sweep's: nothing of the plan stands between the drift and it, and the
/// drift tells what is near (passes/reach.h). Elsewhere it is a pass of its own.
bool sweep_touches_bodies(const Plan& plan);

class BodyTouch {
 public:
  BodyTouch(const Model& model, std::size_t stride);

  /// For one band.
  /// @param list  room for `room(nx)` of them
  Bodies bodies(Drifted* list) const { return {solid_count_, !meshes_.empty(), list, touch_rest, this}; }
  /// Of a row, and the vector before it.
  static std::size_t room(std::size_t nx) { return nx + 2 * kColumns; }

 private:
  static void touch_rest(const void* self, const Kick& kick, const Drifted* list, std::size_t count);
  void touch(const Kick& kick, const Drifted& drifted) const;

  std::size_t stride_;
  std::uint32_t solid_count_;
  std::vector<std::shared_ptr<const DistanceGrid>> meshes_;
  Ground<float> ground_;
};

}  // namespace weft::native
