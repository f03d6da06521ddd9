// Makes one header readable by C++ and GLSL: vector names in C++, the scalar `real` in GLSL. All shared
// structs use scalar layout, so sizes and offsets agree in both languages.
#ifndef WEFT_SHARED_TYPES_H
#define WEFT_SHARED_TYPES_H
#ifdef __cplusplus
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace weft::shared {
using uint = std::uint32_t;
using glm::uvec2;
using glm::vec2;
using glm::vec3;
using glm::vec4;
}  // namespace weft::shared
#define WEFT_SHARED_BEGIN namespace weft::shared {
#define WEFT_SHARED_END }
#define WEFT_CONST inline constexpr
// A struct with reals: a module of GLSL has NAME in its own precision, C++ has NAMEOf<float> and
// NAMEOf<double>.
#define WEFT_REAL_STRUCT(name)                                                            \
  template <class real, class real3 = glm::vec<3, real>, class real4 = glm::vec<4, real>> \
  struct name##Of
#else
// A pass is compiled twice from one text: in float, and with WEFT_F64 in double (precision f64). Literals are
// floats that widen where they meet a double; one that float cannot hold is written as a quotient of two that
// it can.
#ifdef WEFT_F64
#define real double
#define real3 dvec3
#define real4 dvec4
#else
#define real float
#define real3 vec3
#define real4 vec4
#endif
#define WEFT_REAL_STRUCT(name) struct name
#define WEFT_SHARED_BEGIN
#define WEFT_SHARED_END
#define WEFT_CONST const
#endif
#endif
