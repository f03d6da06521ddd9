// Reading OBJ files and refusing those that enclose nothing.
#define TINYOBJLOADER_IMPLEMENTATION  // its code is in its header
#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <sstream>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/file.h"
#include "core/text.h"
#include "model/distance_grid.h"

namespace weft {
namespace {

constexpr std::size_t kMeshBytesMax = std::size_t(64) << 20;
constexpr double kMeshSmallest_m = 1e-3;

bool is_finite_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0.0;
  const char* const end = word.data() + word.size();
  const auto [stopped, failure] = std::from_chars(word.data(), end, value);
  return failure == std::errc() && stopped == end && std::isfinite(value);
}

/// The reader takes what it can of a number, and 0 for what is none.
void check_vertices(const std::string& text, const std::string& name) {
  std::istringstream lines(text);
  std::string line;
  for (std::size_t number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line);
    std::string word;
    if (!(words >> word) || word != "v") continue;
    for (int axis = 0; axis < 3; ++axis)
      if (!(words >> word) || !is_finite_number(word))
        throw error(
            Exit::usage,
            "{}:{}: the vertex is {}; a v line must have three finite numbers (export the mesh again)", name,
            number, in_quotes(line, 80));
  }
}

TriangleMesh parse_obj(const std::string& text, const std::string& name, double scale) {
  check_vertices(text, name);
  tinyobj::ObjReaderConfig config;
  config.triangulate = true;
  config.vertex_color = false;
  tinyobj::ObjReader reader;
  if (!reader.ParseFromString(text, "", config))
    throw error(Exit::usage, "{}: it is no OBJ file ({}); export the mesh as Wavefront OBJ", name,
                in_quotes(reader.Error(), 120));
  TriangleMesh mesh;
  const auto& places = reader.GetAttrib().vertices;
  for (std::size_t k = 0; k + 2 < places.size(); k += 3)
    mesh.vertices.push_back(scale * glm::dvec3(places[k], places[k + 1], places[k + 2]));
  for (const tinyobj::shape_t& shape : reader.GetShapes())
    for (std::size_t k = 0; k + 2 < shape.mesh.indices.size(); k += 3) {
      glm::uvec3 triangle;
      for (int corner = 0; corner < 3; ++corner) {
        const int index = shape.mesh.indices[k + std::size_t(corner)].vertex_index;
        if (index < 0 || std::size_t(index) >= mesh.vertices.size())
          throw error(Exit::usage, "{}: a face names vertex {}; it must be 1 to {} (export the mesh again)",
                      name, index + 1, mesh.vertices.size());
        triangle[corner] = std::uint32_t(index);
      }
      mesh.triangles.push_back(triangle);
    }
  return mesh;
}

/// Vertices at one place become one: exporters split them along seams.
void weld(TriangleMesh& mesh) {
  std::map<std::array<double, 3>, std::uint32_t> first;
  std::vector<std::uint32_t> now(mesh.vertices.size());
  std::vector<glm::dvec3> kept;
  for (std::size_t k = 0; k < mesh.vertices.size(); ++k) {
    const glm::dvec3& v = mesh.vertices[k];
    const auto [entry, is_new] = first.try_emplace({v.x, v.y, v.z}, std::uint32_t(kept.size()));
    if (is_new) kept.push_back(v);
    now[k] = entry->second;
  }
  mesh.vertices = std::move(kept);
  for (glm::uvec3& triangle : mesh.triangles)
    for (int corner = 0; corner < 3; ++corner) triangle[corner] = now[triangle[corner]];
  std::erase_if(mesh.triangles, [](const glm::uvec3& t) { return t.x == t.y || t.y == t.z || t.z == t.x; });
}

void check_size(const TriangleMesh& mesh, const std::string& name) {
  if (mesh.triangles.size() < 4)
    throw error(Exit::usage,
                "{}: it has {} triangles; it must have at least 4 to enclose anything (export a closed mesh)",
                name, mesh.triangles.size());
  if (mesh.triangles.size() > kMeshTrianglesMax)
    throw error(Exit::usage, "{}: it has {} triangles; it must have at most {} (simplify it)", name,
                mesh.triangles.size(), kMeshTrianglesMax);
  glm::dvec3 low(std::numeric_limits<double>::max()), high(-low);
  for (const glm::dvec3& v : mesh.vertices) {
    low = glm::min(low, v);
    high = glm::max(high, v);
  }
  const glm::dvec3 size = high - low;
  const double longest = std::max({size.x, size.y, size.z});
  const double farthest = std::max(glm::length(low), glm::length(high));
  if (!(longest >= kMeshSmallest_m && farthest <= kMeshFarthest_m))
    throw error(
        Exit::usage,
        "{}: it is {} m long and reaches {} m from its origin; it must be {} m long or more and reach "
        "at most {} m (set meshes.scale: 0.01 for a file in cm)",
        name, short_number(longest), short_number(farthest), short_number(kMeshSmallest_m),
        short_number(kMeshFarthest_m));
}

/// Every edge must lead one triangle forwards and one backwards: then the mesh has an inside.
void check_closed(const TriangleMesh& mesh, const std::string& name) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<int, int>> edges;  // forwards, backwards
  for (const glm::uvec3& t : mesh.triangles)
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t a = t[corner], b = t[(corner + 1) % 3];
      auto& count = edges[std::minmax(a, b)];
      ++(a < b ? count.first : count.second);
    }
  const auto bad = [](const auto& edge) { return edge.second != std::pair{1, 1}; };
  const auto count = std::ranges::count_if(edges, bad);
  if (count == 0) return;
  const auto& [ends, uses] = *std::ranges::find_if(edges, bad);
  const glm::dvec3& at = mesh.vertices[ends.first];
  throw error(
      Exit::usage,
      "{}: it is not closed: {} of its {} edges, one at ({}, {}, {}) m, {}; it must enclose a volume, "
      "with every edge shared by two triangles that run against each other (fill its holes, unify its "
      "normals)",
      name, count, edges.size(), short_number(at.x), short_number(at.y), short_number(at.z),
      uses.first + uses.second < 2 ? "have one triangle only" : "have triangles that disagree");
}

void turn_outwards(TriangleMesh& mesh, const std::string& name) {
  double volume = 0.0;
  for (const glm::uvec3& t : mesh.triangles)
    volume += glm::dot(mesh.vertices[t.x], glm::cross(mesh.vertices[t.y], mesh.vertices[t.z])) / 6.0;
  if (volume == 0.0) throw error(Exit::usage, "{}: it encloses no volume; it must have an inside", name);
  if (volume < 0.0)
    for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
}

}  // namespace

TriangleMesh read_mesh(const std::filesystem::path& file, double scale) {
  const std::string name = file.string();
  TriangleMesh mesh = parse_obj(read_file(file, kMeshBytesMax), name, scale);
  weld(mesh);
  check_size(mesh, name);
  check_closed(mesh, name);
  turn_outwards(mesh, name);
  return mesh;
}

}  // namespace weft
