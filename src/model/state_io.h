// A state as files that other programs read: CSV (the canonical one), PLY, OBJ, and a PC2 point cache over
// frames. All appear under their names only when complete.
#pragma once
#include <filesystem>

#include "core/file.h"
#include "model/model.h"

namespace weft {

/// Significant digits of a number in state.csv, enough to read back the same bits.
enum class Digits : int { single = 9, full = 17 };

/// Header `i,j,x,y,z,vx,vy,vz`, one row a particle in particle order [m, m/s].
/// @throws Error(Exit::io)
void write_csv(const std::filesystem::path& file, const Model& model, const State& state, Digits digits);

/// Reads what write_csv wrote; the time is not in the file and stays 0.
/// @throws Error(Exit::io) when unreadable; Error(Exit::usage) with file:line for a bad row or another grid
State read_csv(const std::filesystem::path& file, const Grid& grid);

/// Stanford PLY, ASCII: positions, unit normals and the grid's triangles.
/// @throws Error(Exit::io)
void write_ply(const std::filesystem::path& file, const Model& model, const State& state);

/// Wavefront OBJ: positions, normals, texture coordinates (fractions of the cloth) and the grid's triangles.
/// @throws Error(Exit::io)
void write_obj(const std::filesystem::path& file, const Model& model, const State& state);

/// Unit vertex normals: the adjacent triangles' unnormalised normals, summed; zero where they cancel.
std::vector<glm::dvec3> vertex_normals(const Grid& grid, const State& state);

/// A PC2 point cache: positions of every added state, in single precision, little-endian.
class PointCache {
 public:
  /// @throws Error(Exit::io) when the file cannot be created
  PointCache(const std::filesystem::path& file, const Grid& grid);
  void add(const State& state);
  /// Puts the number of states into the header and the file under its name.
  /// @throws Error(Exit::io)
  void commit();

 private:
  AtomicFile file_;
  std::uint32_t particle_count_, state_count_ = 0;
};

}  // namespace weft
