// Writes states as CSV, PLY, OBJ and PC2; reads CSV.
#include "model/state_io.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <charconv>
#include <glm/geometric.hpp>
#include <iterator>
#include <span>
#include <string>

#include "core/error.h"
#include "model/links.h"

namespace weft {
namespace {

constexpr std::string_view kCsvHeader = "i,j,x,y,z,vx,vy,vz";

/// Calls visit(p, q, r) for both triangles of every cell: A = (i,j) (i,j+1) (i+1,j) and the other half; what
/// is torn is left out.
template <class Visit>
void for_each_triangle(const Grid& grid, std::span<const std::uint32_t> links, Visit&& visit) {
  for (std::uint32_t j = 0; j + 1 < grid.rows(); ++j) {
    if (grid.own_row(j) + 1 == grid.ny) continue;  // below it is another cloth
    for (std::uint32_t i = 0; i + 1 < grid.nx; ++i) {
      const std::uint32_t east = grid.index(i + 1, j), south = grid.index(i, j + 1);
      const std::uint32_t own = grid.index(i, j);
      if (is_whole_a(links, own)) visit(own, south, east);
      if (is_whole_b(links, grid, own)) visit(east, south, grid.index(i + 1, j + 1));
    }
  }
}

std::uint32_t triangle_count(const Grid& grid, const State& state) {
  std::uint32_t count = 0;
  for_each_triangle(grid, state.broken_links, [&](auto...) { ++count; });
  return count;
}

/// Text goes out in pieces, so that a large cloth never stands in memory twice.
class TextFile {
 public:
  explicit TextFile(const std::filesystem::path& target) : file_(target) {}

  template <class... Args>
  void print(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    if (text_.size() > kPieceBytes) flush();
  }
  void commit() {
    flush();
    file_.commit();
  }

 private:
  static constexpr std::size_t kPieceBytes = std::size_t{1} << 20;
  void flush() {
    file_.stream().write(text_.data(), static_cast<std::streamsize>(text_.size()));
    text_.clear();
  }
  AtomicFile file_;
  std::string text_;
};

std::string le_bytes(std::uint32_t value) {
  std::string bytes;
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>((value >> shift) & 0xffu);
  return bytes;
}

std::string pc2_header(std::uint32_t particle_count, std::uint32_t state_count) {
  constexpr std::uint32_t kVersion = 1;
  return std::string("POINTCACHE2\0", 12) + le_bytes(kVersion) + le_bytes(particle_count) +
         le_bytes(std::bit_cast<std::uint32_t>(0.0f)) + le_bytes(std::bit_cast<std::uint32_t>(1.0f)) +
         le_bytes(state_count);
}

/// The eight numbers of one row.
std::array<double, 8> parse_row(std::string_view line, const std::string& place) {
  std::array<double, 8> row;
  const char* at = line.data();
  const char* const end = line.data() + line.size();
  for (std::size_t c = 0; c < row.size(); ++c) {
    const auto [next, status] = std::from_chars(at, end, row[c]);
    const bool last = c + 1 == row.size();
    if (status != std::errc() || (last ? next != end : next == end || *next != ','))
      throw error(Exit::usage, "{}: the row is \"{}\"; it must be eight numbers, {}", place, line,
                  kCsvHeader);
    at = last ? next : next + 1;
  }
  return row;
}

}  // namespace

void write_csv(const std::filesystem::path& file, const Model& model, const State& state, Digits digits) {
  TextFile out(file);
  out.print("{}\n", kCsvHeader);
  const int n = static_cast<int>(digits);
  for (std::uint32_t p = 0; p < model.grid.count(); ++p) {
    const glm::dvec3 &x = state.position[p], &v = state.velocity[p];
    out.print("{},{},{:.{}g},{:.{}g},{:.{}g},{:.{}g},{:.{}g},{:.{}g}\n", p % model.grid.nx, p / model.grid.nx,
              x.x, n, x.y, n, x.z, n, v.x, n, v.y, n, v.z, n);
  }
  out.commit();
}

State read_csv(const std::filesystem::path& file, const Grid& grid) {
  const std::string text = read_file(file);
  State state;
  std::size_t line_number = 0, begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view line(text.data() + begin, end - begin);
    if (line.ends_with('\r')) line.remove_suffix(1);
    begin = end + 1;
    const std::string place = fmt::format("{}:{}", file.string(), ++line_number);
    if (line_number == 1) {
      if (line != kCsvHeader) throw error(Exit::usage, "{}: the header must be {}", place, kCsvHeader);
      continue;
    }
    const std::array<double, 8> row = parse_row(line, place);
    const std::size_t p = state.position.size(), i = p % grid.nx, j = p / grid.nx;
    if (p >= grid.count() || row[0] != double(i) || row[1] != double(j))
      throw error(Exit::usage, "{}: particle ({}, {}) is out of order for a cloth of {} x {}", place, row[0],
                  row[1], grid.nx, grid.rows());
    state.position.emplace_back(row[2], row[3], row[4]);
    state.velocity.emplace_back(row[5], row[6], row[7]);
  }
  if (state.position.size() != grid.count())
    throw error(Exit::usage, "{}: there are {} particles; the cloth has {}", file.string(),
                state.position.size(), grid.count());
  return state;
}

std::vector<glm::dvec3> vertex_normals(const Grid& grid, const State& state) {
  std::vector<glm::dvec3> normals(grid.count(), glm::dvec3(0.0));
  for_each_triangle(grid, state.broken_links, [&](std::uint32_t p, std::uint32_t q, std::uint32_t r) {
    const glm::dvec3 n =
        glm::cross(state.position[q] - state.position[p], state.position[r] - state.position[p]);
    for (const std::uint32_t corner : {p, q, r}) normals[corner] += n;
  });
  for (glm::dvec3& n : normals) {
    const double l = glm::length(n);
    n = l > 1e-30 ? n / l : glm::dvec3(0.0);
  }
  return normals;
}

void write_ply(const std::filesystem::path& file, const Model& model, const State& state) {
  const Grid& grid = model.grid;
  const std::vector<glm::dvec3> normals = vertex_normals(grid, state);
  TextFile out(file);
  out.print("ply\nformat ascii 1.0\nelement vertex {}\n", grid.count());
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) out.print("property float {}\n", name);
  out.print("element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
            triangle_count(grid, state));
  for (std::uint32_t p = 0; p < grid.count(); ++p) {
    const glm::dvec3 &x = state.position[p], &n = normals[p];
    out.print("{:.9g} {:.9g} {:.9g} {:.6g} {:.6g} {:.6g}\n", x.x, x.y, x.z, n.x, n.y, n.z);
  }
  for_each_triangle(grid, state.broken_links, [&](std::uint32_t p, std::uint32_t q, std::uint32_t r) {
    out.print("3 {} {} {}\n", p, q, r);
  });
  out.commit();
}

void write_obj(const std::filesystem::path& file, const Model& model, const State& state) {
  const Grid& grid = model.grid;
  const std::vector<glm::dvec3> normals = vertex_normals(grid, state);
  TextFile out(file);
  out.print("o cloth\n");
  for (const glm::dvec3& x : state.position) out.print("v {:.9g} {:.9g} {:.9g}\n", x.x, x.y, x.z);
  for (std::uint32_t j = 0; j < grid.rows(); ++j)
    for (std::uint32_t i = 0; i < grid.nx; ++i)
      out.print("vt {:.6g} {:.6g}\n", double(i) / (grid.nx - 1),
                1.0 - double(grid.own_row(j)) / (grid.ny - 1));
  for (const glm::dvec3& n : normals) out.print("vn {:.6g} {:.6g} {:.6g}\n", n.x, n.y, n.z);
  for_each_triangle(grid, state.broken_links, [&](std::uint32_t p, std::uint32_t q, std::uint32_t r) {
    out.print("f {0}/{0}/{0} {1}/{1}/{1} {2}/{2}/{2}\n", p + 1, q + 1, r + 1);
  });
  out.commit();
}

PointCache::PointCache(const std::filesystem::path& file, const Grid& grid)
    : file_(file), particle_count_(grid.count()) {
  file_.stream() << pc2_header(particle_count_, 0);
}

void PointCache::add(const State& state) {
  WEFT_ASSERT(state.position.size() == particle_count_);
  std::string bytes;
  bytes.reserve(state.position.size() * 12);
  for (const glm::dvec3& x : state.position)
    for (int d = 0; d < 3; ++d) bytes += le_bytes(std::bit_cast<std::uint32_t>(static_cast<float>(x[d])));
  file_.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  ++state_count_;
}

void PointCache::commit() {
  file_.stream().seekp(0);
  file_.stream() << pc2_header(particle_count_, state_count_);
  file_.commit();
}

}  // namespace weft
