// Distance grids between runs: one file each, named by what the mesh's file, its scale, resolution and margin
// are, with a checksum, since anything may have happened to it.
#include <cstring>

#include "core/cache.h"
#include "core/error.h"
#include "core/file.h"
#include "core/text.h"
#include "model/distance_grid.h"

namespace weft {
namespace {

constexpr std::size_t kGridBytesMax = std::size_t(256) << 20;

struct GridHeader {
  char magic[8] = {'W', 'E', 'F', 'T', 'S', 'D', '0', '1'};
  double low_m[3] = {}, cell_m = 0.0;
  std::uint32_t samples[3] = {}, reserved = 0;
  std::uint64_t checksum = 0;
};

template <class T>
std::string_view bytes_of_value(const T& value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

std::filesystem::path grid_file(const std::filesystem::path& mesh, const MeshSection& section,
                                double margin_m) {
  const std::filesystem::path folder = cache_folder();
  if (folder.empty()) return {};
  std::uint64_t hash = fnv1a_64(read_file(mesh));
  hash = fnv1a_64(bytes_of_value(section.scale), hash);
  hash = fnv1a_64(bytes_of_value(section.resolution), hash);
  hash = fnv1a_64(bytes_of_value(margin_m), hash);
  return folder / fmt::format("mesh-{:016x}.bin", hash);
}

/// False, and the grid as it was, when the file is not there or not whole.
bool read_grid(const std::filesystem::path& file, DistanceGrid& grid) {
  std::error_code failure;
  if (file.empty() || !std::filesystem::is_regular_file(file, failure)) return false;
  const std::string bytes = read_file(file, kGridBytesMax);
  GridHeader header;
  const GridHeader ours;
  if (bytes.size() < sizeof header) return false;
  std::memcpy(&header, bytes.data(), sizeof header);
  const std::size_t count = std::size_t{header.samples[0]} * header.samples[1] * header.samples[2];
  const std::string_view body = std::string_view(bytes).substr(sizeof header);
  if (std::memcmp(header.magic, ours.magic, sizeof ours.magic) != 0 || body.size() != count * sizeof(float) ||
      header.checksum != fnv1a_64(body))
    return false;
  grid.low_m = {header.low_m[0], header.low_m[1], header.low_m[2]};
  grid.cell_m = header.cell_m;
  grid.samples = {header.samples[0], header.samples[1], header.samples[2]};
  grid.distance.resize(count);
  std::memcpy(grid.distance.data(), body.data(), body.size());
  return true;
}

/// A cache that cannot be written is none: the grid is there all the same.
void write_grid(const std::filesystem::path& file, const DistanceGrid& grid) {
  if (file.empty()) return;
  const std::string_view body(reinterpret_cast<const char*>(grid.distance.data()),
                              grid.distance.size() * sizeof(float));
  GridHeader header;
  for (int axis = 0; axis < 3; ++axis) {
    header.low_m[axis] = grid.low_m[axis];
    header.samples[axis] = grid.samples[axis];
  }
  header.cell_m = grid.cell_m;
  header.checksum = fnv1a_64(body);
  try {
    std::filesystem::create_directories(file.parent_path());
    write_file(file, std::string(bytes_of_value(header)).append(body));
  } catch (const std::exception&) {
    return;
  }
}

}  // namespace

std::filesystem::path mesh_file(const Scene& scene, const MeshSection& mesh) {
  const std::filesystem::path named(mesh.file);
  return named.is_absolute() ? named : std::filesystem::path(scene.source).parent_path() / named;
}

namespace {

/// What is wrong with the file, with the entry that names it in front.
TriangleMesh read_mesh_of(const Scene& scene, std::size_t item) {
  const MeshSection& section = scene.meshes[item];
  try {
    return read_mesh(mesh_file(scene, section), section.scale);
  } catch (const Error& failure) {
    const std::string key = fmt::format("meshes.{}.file", item);
    throw error(failure.code(), "{}: {} is {}; {}", place_of(scene, key), key, in_quotes(section.file, 80),
                failure.what());
  }
}

}  // namespace

std::shared_ptr<const DistanceGrid> load_distance_grid(const Scene& scene, std::size_t item,
                                                       double half_thickness_m) {
  const MeshSection& section = scene.meshes.at(item);
  const std::filesystem::path file = mesh_file(scene, section);
  TriangleMesh mesh = read_mesh_of(scene, item);
  if (const double most_m = 0.25 * longest_side_m(mesh); half_thickness_m > most_m)
    throw error(
        Exit::usage,
        "{}: self_collision.thickness is {} m with the mesh {}; it must be at most half of the mesh's "
        "longest side, {} m (use a thinner cloth or a larger mesh)",
        place_of(scene, "self_collision.thickness"), short_number(2.0 * half_thickness_m), file.string(),
        short_number(2.0 * most_m));
  const std::filesystem::path kept = grid_file(file, section, half_thickness_m);
  auto grid = std::make_shared<DistanceGrid>();
  if (read_grid(kept, *grid)) {
    grid->mesh = std::move(mesh);
    return grid;
  }
  *grid = make_distance_grid(std::move(mesh), section.resolution, half_thickness_m);
  write_grid(kept, *grid);
  return grid;
}

}  // namespace weft
