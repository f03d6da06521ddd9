// A closed triangle mesh as distances on a grid: negative inside, in metres, in the mesh's own frame.
#pragma once
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "model/solids.h"
#include "scene/scene.h"

namespace weft {

/// Triangles of a file, scaled to metres, counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<glm::dvec3> vertices;  ///< [m]
  std::vector<glm::uvec3> triangles;
};

struct DistanceGrid {
  glm::dvec3 low_m{0.0};        ///< its lowest corner
  double cell_m = 0.0;          ///< edge of its cubic cells
  glm::uvec3 samples{0};        ///< along x, y, z
  std::vector<float> distance;  ///< [m], x fastest; shape [x·y·z]
  TriangleMesh mesh;            ///< what is drawn
};

/// Reads an OBJ file.
/// @param scale  metres of one of its units
/// @throws Error(Exit::io) when it cannot be read; Error(Exit::usage) when it is no OBJ, is open, has edges
/// that other than two triangles share, is flat, or is larger than kMeshTrianglesMax or than 1000 m
TriangleMesh read_mesh(const std::filesystem::path& file, double scale);

inline constexpr std::size_t kMeshTrianglesMax = 200000;
inline constexpr double kMeshFarthest_m = 1000.0;  ///< from its origin

/// Of all meshes of a scene together: a float counts them one by one.
inline constexpr std::size_t kMeshSamplesMax = std::size_t(1) << 24;

/// Of its bounding box [m].
double longest_side_m(const TriangleMesh& mesh);

/// @param cells     along the longest side
/// @param margin_m  around the mesh, two cells more or less
DistanceGrid make_distance_grid(TriangleMesh mesh, std::uint32_t cells, double margin_m);

/// The grid of a mesh of a scene, from the cache when it holds it. The cache is found again by what the file
/// says, its scale, resolution and margin.
/// @param half_thickness_m  of the cloth
/// @param item  of the scene's meshes
/// @throws Error as read_mesh, with the place and key of the entry in front
std::shared_ptr<const DistanceGrid> load_distance_grid(const Scene& scene, std::size_t item,
                                                       double half_thickness_m);

/// The file a mesh names: from the folder of the scene's file.
std::filesystem::path mesh_file(const Scene& scene, const MeshSection& mesh);

/// Distance [m] of a point in the mesh's own frame, between the samples by trilinear interpolation; outside
/// of the grid at least the way to it.
double distance_at(const DistanceGrid& grid, const glm::dvec3& own_m);

/// Where the mesh's origin is and how it is turned.
SolidFrame frame_at(const MeshSection& mesh, double time_s);

}  // namespace weft
