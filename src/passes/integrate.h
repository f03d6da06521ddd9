// The integration pass's specialization constants by name: what each id means, for the mirror and for solvers
// that share its force.
#pragma once
#include <array>
#include <string_view>

#include "passes/force_sweep.h"
#include "passes/pass.h"

namespace weft {

/// Constant ids of integrate.comp, in order.
enum IntegrateConstant {
  kHasShear,
  kHasFlex,
  kHasBending,
  kHasDamping,
  kHasAir,
  kHasWind,
  kHasGravity,
  kHasFloor,
  kHasSpheres,
  kHasPins,
  kIntegrateConstantCount
};

inline constexpr std::array<std::string_view, kIntegrateConstantCount> kIntegrateConstantNames{
    "shear", "flex", "bending", "damping", "air", "wind", "gravity", "floor", "spheres", "pins"};

/// The constant "spheres" is their number, up to this, which stands for any more: few of them take no loop.
inline constexpr std::size_t kSpheresLooped = 3;

/// Which effects the model's scene calls for; one entry an IntegrateConstant.
Constants integrate_constants(const Model& model);

/// The springs that the constants switch on.
inline ForceEffects force_effects(std::span<const Constant> constants) {
  return {constants[kHasShear].value != 0,
          constants[kHasFlex].value != 0 || constants[kHasBending].value != 0,
          constants[kHasDamping].value != 0};
}

}  // namespace weft
