// What a scene file can say, as plain data in SI units. An absent section is an effect that is not
// simulated. Defaults are those of docs/scene-format.md; reading and checking live in reader.h.
#pragma once
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weft {

enum class Orientation { vertical, horizontal };

/// Where something scripted is at one moment. From key to key it moves steadily; before the first and after
/// the last it stands still.
struct MotionKey {
  double time_s = 0.0;
  glm::dvec3 place_m{0.0};       ///< a collider's centre; a pin's offset from its place at the cloth's start
  glm::dvec3 rotation_deg{0.0};  ///< of capsules, boxes and meshes: about x, then y, then z
  bool operator==(const MotionKey&) const = default;
};
using MotionKeys = std::vector<MotionKey>;

struct ClothSection {
  double width_m = 1.0;
  double height_m = 1.0;
  std::uint32_t resolution = 64;  ///< particles along the width
  Orientation orientation = Orientation::vertical;
  glm::dvec3 center_m{0.0};
  double imperfection_m = 0.0;
};

/// A further cloth: size, resolution and material are the scene's.
struct SheetSection {
  glm::dvec3 center_m{0.0};                ///< required
  std::optional<Orientation> orientation;  ///< absent: that of [cloth]
  std::optional<double> imperfection_m;    ///< absent: that of [cloth]
  bool operator==(const SheetSection&) const = default;
};

struct MaterialSection {
  std::string preset;  ///< name in assets/materials, empty when none
  double density_kg_m2 = 0.2;
  double membrane_n_m = 1000.0;
  std::optional<double> shear_n_m;  ///< absent: 3/8 of membrane (isotropic, Poisson 1/3), the mean of both
  std::optional<double> membrane_warp_n_m, membrane_weft_n_m;  ///< absent: membrane
  double flex = 0.25;     ///< share of the membrane stiffness that the flex springs carry
  double bend_n_m = 0.0;  ///< bending rigidity B [N·m]
  std::optional<double> bend_warp_n_m, bend_weft_n_m;  ///< absent: bend
  double damping_s = 1e-4;
  double damping_ratio_max = 0.1;
  double strain_limit = 0.0;  ///< largest elongation of structural and shear springs over their rest; 0: none

  // The weft runs along the width (i), the warp along the height (j).
  double membrane_weft() const { return membrane_weft_n_m.value_or(membrane_n_m); }
  double membrane_warp() const { return membrane_warp_n_m.value_or(membrane_n_m); }
  double shear() const { return shear_n_m.value_or(0.375 * (0.5 * (membrane_weft() + membrane_warp()))); }
  double bend_weft() const { return bend_weft_n_m.value_or(bend_n_m); }
  double bend_warp() const { return bend_warp_n_m.value_or(bend_n_m); }
  bool bends() const { return bend_weft() > 0.0 || bend_warp() > 0.0; }
  /// One rigidity in both directions [N·m].
  void set_bend(double n_m) { bend_n_m = n_m, bend_warp_n_m = bend_weft_n_m = std::nullopt; }
};

struct PinSection {
  glm::dvec2 at{0.0};  ///< fractions of width and real height; (0,0) is the top-left corner
  double radius_m = 0.05;
  MotionKeys keys = {};                  ///< of its offset; empty: it stays
  std::string attach = {};               ///< "spheres.0": it goes with that sphere; empty: with none
  std::optional<double> release_s = {};  ///< when it lets go; absent: never
  std::uint32_t cloth = 0;               ///< which one it holds: 0 is [cloth], 1 the first of [[cloths]]

  bool moves() const { return !keys.empty() || !attach.empty(); }
  bool operator==(const PinSection&) const = default;
};

struct GravitySection {
  glm::dvec3 acceleration_m_s2{0.0, -9.81, 0.0};
};

struct AirSection {
  double drag_kg_m2_s = 0.0;  ///< required in its section
};

struct WindSection {
  glm::dvec3 velocity_m_s{0.0};  ///< required in its section
  double gust = 0.0;
  double period_s = 0.0;        ///< required when gust > 0
  double noise_m_s = 0.0;       ///< what each component differs by from place to place, at most
  double noise_scale_m = 1.0;   ///< from one eddy to the next
  double noise_period_s = 1.0;  ///< in which the eddies become others
  std::uint32_t seed = 1;       ///< of the noise
};

/// Drag and lift by triangle, quadratic in the speed.
struct AerodynamicsSection {
  double density_kg_m3 = 1.2;  ///< of the air
  double drag = 1.28;          ///< coefficient of a flat plate across the flow
  double lift = 0.5;           ///< coefficient
};

struct FloorSection {
  double height_m = 0.0;  ///< of the point below the origin, where x = z = 0
  double friction = 0.0;
  glm::dvec3 normal{0.0, 1.0, 0.0};  ///< out of the floor; any length

  bool is_level() const { return normal.x == 0.0 && normal.z == 0.0; }
  bool operator==(const FloorSection&) const = default;
};

struct SphereSection {
  glm::dvec3 center_m{0.0};
  double radius_m = 0.0;  ///< required
  glm::dvec3 velocity_m_s{0.0};
  double friction = 0.0;
  MotionKeys keys = {};  ///< of its centre; with keys, center_m is the first and velocity_m_s is not used
  bool operator==(const SphereSection&) const = default;
};

/// What capsules, boxes and meshes have in common.
struct SolidSection {
  glm::dvec3 velocity_m_s{0.0};
  double friction = 0.0;
  MotionKeys keys = {};  ///< of its centre and of what it is turned by on top of its own rotation
  bool operator==(const SolidSection&) const = default;
};

struct CapsuleSection : SolidSection {
  glm::dvec3 a_m{0.0}, b_m{0.0};  ///< ends of its axis; required
  double radius_m = 0.0;          ///< required
  bool operator==(const CapsuleSection&) const = default;
};

struct BoxSection : SolidSection {
  glm::dvec3 center_m{0.0};      ///< required, or keys
  glm::dvec3 size_m{0.0};        ///< full edges along its own axes; required
  glm::dvec3 rotation_deg{0.0};  ///< about x, then y, then z
  bool operator==(const BoxSection&) const = default;
};

struct MeshSection : SolidSection {
  std::string file;               ///< OBJ, beside the scene's file; required
  glm::dvec3 center_m{0.0};       ///< where the file's origin is; required, or keys
  glm::dvec3 rotation_deg{0.0};   ///< about x, then y, then z
  double scale = 1.0;             ///< metres of one unit of the file
  std::uint32_t resolution = 64;  ///< cells of the distance grid along the longest side
  bool operator==(const MeshSection&) const = default;
};

/// Keeps every particle within reach of the pinned one that is nearest on the flat cloth; XPBD only.
struct TethersSection {
  double slack = 0.0;  ///< that a tether may be longer than the way on the flat cloth, relative
};

struct TearingSection {
  double strain = 0.0;  ///< elongation at which a link breaks; required in its section
};

struct SelfCollisionSection {
  double thickness_m = 0.0;  ///< required in its section
  double friction = 0.0;     ///< between layers
};

struct SolverSection {
  std::string name = "leapfrog";
  std::uint32_t substeps = 0;  ///< a frame; 0 = automatic, from the step bound
  std::string precision = "f32";
  double frame_s = 1.0 / 60.0;
};

/// Checks a scene makes of itself; the tests run them at `at_time` (default: the run's end).
struct ExpectSection {
  std::optional<double> max_stretch, p99_stretch, lowest_y_m, highest_y_m, energy_max_j, at_time_s;
};

/// Where keys and sections were given: "meshes.0.file" and "meshes.0" → "scene.toml:9", or the `--set`.
using Places = std::map<std::string, std::string, std::less<>>;

struct Scene {
  std::string title;
  std::string source;  ///< path of the file, for messages
  Places places;       ///< of what the file and `--set` gave, for messages
  ClothSection cloth;
  std::vector<SheetSection> cloths;  ///< beyond the first
  MaterialSection material;
  std::vector<PinSection> pins;
  std::optional<GravitySection> gravity;
  std::optional<AirSection> air;
  std::optional<WindSection> wind;
  std::optional<AerodynamicsSection> aerodynamics;
  std::optional<FloorSection> floor;
  std::vector<SphereSection> spheres;
  std::vector<CapsuleSection> capsules;
  std::vector<BoxSection> boxes;
  std::vector<MeshSection> meshes;
  std::optional<SelfCollisionSection> self_collision;
  std::optional<TethersSection> tethers;
  std::optional<TearingSection> tearing;
  SolverSection solver;
  std::optional<ExpectSection> expect;
};

/// The place of a key such as "meshes.0.file"; of its section when the key is not given; of the file when
/// neither is; "scene" where there is no file.
std::string place_of(const Scene& scene, std::string_view key);

/// [cloth] and [[cloths]] together.
inline std::uint32_t cloth_count(const Scene& scene) {
  return 1 + static_cast<std::uint32_t>(scene.cloths.size());
}

/// The whole of one cloth: 0 is [cloth], 1 the first of [[cloths]].
ClothSection cloth_of(const Scene& scene, std::size_t index);

/// The sphere that a pin goes with, as an index in Scene::spheres; nothing when there is none of that name.
std::optional<std::size_t> attached_sphere(const Scene& scene, const PinSection& pin);

}  // namespace weft
