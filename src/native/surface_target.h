// Where what is drawn goes.
#pragma once
#include <cstdint>

namespace weft::native {

/// vec4 a particle. Normal or velocity may be null.
struct SurfaceTarget {
  float *position, *normal, *velocity = nullptr;
  std::uint32_t* torn_mesh = nullptr;  ///< of a cloth that tears: the list of indices
};

}  // namespace weft::native
