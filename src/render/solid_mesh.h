// Triangles of capsules, boxes and meshes in their own frames, and where these are.
#pragma once
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "model/model.h"

namespace weft {

/// Where one body's triangles are in the common list.
struct BodyRange {
  std::uint32_t first_index = 0, index_count = 0;
};

struct SolidTriangles {
  std::vector<glm::vec4> position, normal;  ///< [m], unit; w unused
  std::vector<std::uint32_t> indices;       ///< counter-clockwise seen from outside
  std::vector<BodyRange> bodies;            ///< capsules, boxes, then meshes, each in scene order
};

/// Rounded edges and surfaces lie a little inside of where contact holds the cloth's particles, so that the
/// flat triangles between these stay outside.
SolidTriangles solid_triangles(const Model& model);

std::size_t body_count(const Model& model);

/// From a body's own frame to the world at a time.
glm::mat4 body_frame(const Model& model, std::size_t body, double time_s);

/// Distance [m] from the frame's origin to the body's farthest point.
double body_extent_m(const Model& model, std::size_t body);

}  // namespace weft
