// Makes one header readable by C++ and GLSL: vector names in C++, nothing in GLSL. All shared
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
#else
#define WEFT_SHARED_BEGIN
#define WEFT_SHARED_END
#define WEFT_CONST const
#endif
#endif
