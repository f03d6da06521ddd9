// The rows of the parameter table. A new parameter is one member in scene.h and one row here.

#include "scene/parameter_access.h"
#include "scene/parameters.h"

namespace weft {
namespace {

using parameter_access::row;

ParameterValue get_title(const Scene& scene, std::size_t) { return scene.title; }
void set_title(Scene& scene, std::size_t, const ParameterValue& value) {
  scene.title = std::get<std::string>(value);
}

ParameterValue get_shear(const Scene& scene, std::size_t) { return scene.material.shear(); }
void set_shear(Scene& scene, std::size_t, const ParameterValue& value) {
  scene.material.shear_n_m = std::get<double>(value);
}

ParameterValue get_substeps(const Scene& scene, std::size_t) {
  if (scene.solver.substeps == 0) return std::string("auto");
  return static_cast<double>(scene.solver.substeps);
}
void set_substeps(Scene& scene, std::size_t, const ParameterValue& value) {
  const double* count = std::get_if<double>(&value);
  scene.solver.substeps = count != nullptr ? static_cast<std::uint32_t>(*count) : 0;
}

using enum ParameterKind;

// Ranges are as wide as the solvers are tested for, and no wider: a value outside is a slip of the keyboard
// or of the unit. 1e4 m keeps a float's last bit below a millimetre.
constexpr double kFarthest_m = 1e4;

// The solvers of src/solvers, which lies above this folder; its tests hold the two lists together.
constexpr std::string_view kSolverNames =
    "leapfrog|velocity-verlet|symplectic-euler|verlet|euler|trapezoid|rk4|xpbd";

const Parameter kTable[] = {
    {.section = "",
     .key = "title",
     .kind = word,
     .about = "name shown in lists and in the window",
     .example = "title = \"Flag\"",
     .default_text = "the file's name",
     .get = get_title,
     .set = set_title},

    row<&Scene::cloth, &ClothSection::width_m>({.section = "cloth",
                                                .key = "width",
                                                .minimum = 1e-3,
                                                .maximum = 1000,

                                                .unit = "m",
                                                .about = "size of the cloth along i",
                                                .example = "a flag: 1.5"}),
    row<&Scene::cloth, &ClothSection::height_m>(
        {.section = "cloth",
         .key = "height",
         .minimum = 1e-3,
         .maximum = 1000,

         .unit = "m",
         .about = "size along j; the real height is the nearest whole number of square cells",
         .example = "a flag: 1.0"}),
    row<&Scene::cloth, &ClothSection::resolution>({.section = "cloth",
                                                   .key = "resolution",
                                                   .kind = integer,
                                                   .minimum = 2,
                                                   .maximum = 4096,
                                                   .slider_minimum = 8,
                                                   .slider_maximum = 512,
                                                   .slider_logarithmic = true,
                                                   .about = "particles along the width; cells are square",
                                                   .example = "40 runs on any machine"}),
    row<&Scene::cloth, &ClothSection::orientation>(
        {.section = "cloth",
         .key = "orientation",
         .kind = word,
         .about = "vertical hangs in the x–y plane, horizontal lies in the x–z plane",
         .example = "a flag: \"vertical\"",
         .words = "vertical|horizontal"}),
    row<&Scene::cloth, &ClothSection::center_m>({.section = "cloth",
                                                 .key = "center",
                                                 .kind = vec3,
                                                 .minimum = -kFarthest_m,
                                                 .maximum = kFarthest_m,
                                                 .unit = "m",
                                                 .about = "middle of the cloth at the start",
                                                 .example = "[0, 1.2, 0]"}),
    row<&Scene::cloth, &ClothSection::imperfection_m>(
        {.section = "cloth",
         .key = "imperfection",
         .maximum = 1,
         .slider_maximum = 0.05,
         .unit = "m",
         .about = "smooth displacement of the start along the normal, so that round-off does not choose how "
                  "it buckles",
         .example = "0.005"}),

    row<&Scene::material, &MaterialSection::preset>(
        {.section = "material",
         .key = "preset",
         .kind = word,
         .about = "a name in assets/materials; other keys here override it",
         .example = "\"denim\"",
         .default_text = "none"}),
    row<&Scene::material, &MaterialSection::density_kg_m2>({.section = "material",
                                                            .key = "density",
                                                            .minimum = 1e-3,
                                                            .maximum = 100,
                                                            .slider_minimum = 0.02,
                                                            .slider_maximum = 1,
                                                            .slider_logarithmic = true,
                                                            .unit = "kg/m²",
                                                            .about = "mass of a square metre",
                                                            .example = "cotton: 0.15"}),
    row<&Scene::material, &MaterialSection::membrane_n_m>(
        {.section = "material",
         .key = "membrane",
         .maximum = 1e8,
         .slider_minimum = 50,
         .slider_maximum = 20000,
         .slider_logarithmic = true,
         .unit = "N/m",
         .about = "stiffness in the plane: force per width at full strain",
         .example = "soft cotton: 600"}),
    {.section = "material",
     .key = "shear",
     .maximum = 1e8,
     .slider_minimum = 10,
     .slider_maximum = 10000,
     .slider_logarithmic = true,
     .unit = "N/m",
     .about = "stiffness against shear; the default is isotropic, Poisson 1/3",
     .example = "3/8 of membrane",
     .default_text = "3/8 of membrane",
     .get = get_shear,
     .set = set_shear},
    row<&Scene::material, &MaterialSection::flex>(
        {.section = "material",
         .key = "flex",
         .maximum = 1,
         .slider_maximum = 1,
         .about = "share of the membrane stiffness that the springs over two cells carry",
         .example = "0.25"}),
    row<&Scene::material, &MaterialSection::bend_n_m>(
        {.section = "material",
         .key = "bend",
         .maximum = 10,
         .slider_minimum = 1e-7,
         .slider_maximum = 1e-2,
         .slider_logarithmic = true,
         .unit = "N·m",
         .about = "bending rigidity; 0 leaves its arithmetic out",
         .example = "cotton: 1e-5"}),
    row<&Scene::material, &MaterialSection::damping_s>(
        {.section = "material",
         .key = "damping",
         .maximum = 10,
         .slider_maximum = 1e-3,
         .unit = "s",
         .about = "damping time: damping coefficient over stiffness of each spring",
         .example = "1e-4"}),
    row<&Scene::material, &MaterialSection::damping_ratio_max>(
        {.section = "material",
         .key = "damping_ratio_max",
         .maximum = 10,
         .slider_maximum = 1,
         .about = "cap of each spring's damping ratio, so that fine grids need no tiny steps",
         .example = "0.1"}),

    row<&Scene::pins, &PinSection::at>(
        {.section = "pins",
         .key = "at",
         .kind = vec2,
         .maximum = 1,
         .required = true,
         .about = "place on the flat cloth as fractions of width and height; [0, 0] is the top-left corner",
         .example = "top-right corner: [1, 0]"}),
    row<&Scene::pins, &PinSection::radius_m>({.section = "pins",
                                              .key = "radius",
                                              .maximum = 1000,
                                              .slider_minimum = 0.005,
                                              .slider_maximum = 0.2,
                                              .unit = "m",
                                              .about = "every particle within it is held",
                                              .example = "0.05"}),

    row<&Scene::gravity, &GravitySection::acceleration_m_s2>({.section = "gravity",
                                                              .key = "acceleration",
                                                              .kind = vec3,
                                                              .minimum = -1e4,
                                                              .maximum = 1e4,
                                                              .slider_minimum = -25,
                                                              .slider_maximum = 25,
                                                              .unit = "m/s²",
                                                              .about = "acceleration of every free particle",
                                                              .example = "[0, -9.81, 0]"}),

    row<&Scene::air, &AirSection::drag_kg_m2_s>({.section = "air",
                                                 .key = "drag",
                                                 .maximum = 1e4,
                                                 .required = true,
                                                 .slider_maximum = 2,
                                                 .unit = "kg/(m²·s)",
                                                 .about = "force per area and speed relative to the air",
                                                 .example = "0.1"}),

    row<&Scene::wind, &WindSection::velocity_m_s>({.section = "wind",
                                                   .key = "velocity",
                                                   .kind = vec3,
                                                   .minimum = -1000,
                                                   .maximum = 1000,
                                                   .required = true,
                                                   .slider_minimum = -20,
                                                   .slider_maximum = 20,
                                                   .unit = "m/s",
                                                   .about = "mean velocity of the air; needs [air]",
                                                   .example = "[0, 0, 3]"}),
    row<&Scene::wind, &WindSection::gust>({.section = "wind",
                                           .key = "gust",
                                           .maximum = 100,
                                           .slider_maximum = 2,
                                           .about = "the wind swings by this share of itself",
                                           .example = "0.5"}),
    row<&Scene::wind, &WindSection::period_s>({.section = "wind",
                                               .key = "period",
                                               .maximum = 1e6,
                                               .slider_minimum = 0.1,
                                               .slider_maximum = 10,
                                               .slider_logarithmic = true,
                                               .unit = "s",
                                               .about = "time of one swing; required when gust > 0",
                                               .example = "2"}),

    row<&Scene::floor, &FloorSection::height_m>({.section = "floor",
                                                 .key = "height",
                                                 .minimum = -kFarthest_m,
                                                 .maximum = kFarthest_m,
                                                 .unit = "m",
                                                 .about = "level of the floor",
                                                 .example = "0"}),
    row<&Scene::floor, &FloorSection::friction>({.section = "floor",
                                                 .key = "friction",
                                                 .maximum = 100,
                                                 .slider_maximum = 1,
                                                 .about = "Coulomb coefficient",
                                                 .example = "0.3"}),

    row<&Scene::spheres, &SphereSection::center_m>({.section = "spheres",
                                                    .key = "center",
                                                    .kind = vec3,
                                                    .minimum = -kFarthest_m,
                                                    .maximum = kFarthest_m,
                                                    .required = true,
                                                    .unit = "m",
                                                    .about = "middle of the sphere at the start",
                                                    .example = "[0, 0.5, 0]"}),
    row<&Scene::spheres, &SphereSection::radius_m>({.section = "spheres",
                                                    .key = "radius",
                                                    .minimum = 1e-4,
                                                    .maximum = 1000,

                                                    .required = true,
                                                    .slider_minimum = 0.02,
                                                    .slider_maximum = 1,
                                                    .unit = "m",
                                                    .about = "radius of the sphere",
                                                    .example = "0.25"}),
    row<&Scene::spheres, &SphereSection::velocity_m_s>({.section = "spheres",
                                                        .key = "velocity",
                                                        .kind = vec3,
                                                        .minimum = -1000,
                                                        .maximum = 1000,
                                                        .unit = "m/s",
                                                        .about = "the sphere moves steadily with it",
                                                        .example = "[0, 0, 1]"}),
    row<&Scene::spheres, &SphereSection::friction>({.section = "spheres",
                                                    .key = "friction",
                                                    .maximum = 100,
                                                    .slider_maximum = 1,
                                                    .about = "Coulomb coefficient",
                                                    .example = "0.3"}),

    row<&Scene::self_collision, &SelfCollisionSection::thickness_m>(
        {.section = "self_collision",
         .key = "thickness",
         .minimum = 1e-6,
         .maximum = 1,

         .required = true,
         .slider_minimum = 0.001,
         .slider_maximum = 0.02,
         .slider_logarithmic = true,
         .unit = "m",
         .about = "full thickness of the cloth in contact",
         .example = "0.004"}),

    row<&Scene::solver, &SolverSection::name>({.section = "solver",
                                               .key = "name",
                                               .kind = word,
                                               .about = "how time is stepped; `weft solvers` lists them",
                                               .example = "\"leapfrog\"",
                                               .words = kSolverNames}),
    {.section = "solver",
     .key = "substeps",
     .kind = integer,
     .minimum = 1,
     .maximum = 1e6,
     .about = "steps a frame; \"auto\" follows the largest stable step",
     .example = "\"auto\"",
     .words = "auto",
     .get = get_substeps,
     .set = set_substeps},
    row<&Scene::solver, &SolverSection::precision>({.section = "solver",
                                                    .key = "precision",
                                                    .kind = word,
                                                    .about = "float, float with compensated sums, or double",
                                                    .example = "\"f32\"",
                                                    .words = "f32|f32k|f64"}),
    row<&Scene::solver, &SolverSection::frame_s>({.section = "solver",
                                                  .key = "frame",
                                                  .minimum = 1e-6,
                                                  .maximum = 10,
                                                  .unit = "s",
                                                  .about = "length of a frame",
                                                  .example = "0.0166667",
                                                  .default_text = "1/60"}),

    row<&Scene::expect, &ExpectSection::max_stretch>(
        {.section = "expect",
         .key = "max_stretch",
         .maximum = 1e6,
         .about = "largest elongation of a structural spring, over its rest length, is at most this",
         .example = "0.1",
         .default_text = "not checked"}),
    row<&Scene::expect, &ExpectSection::p99_stretch>(
        {.section = "expect",
         .key = "p99_stretch",
         .maximum = 1e6,
         .about = "99 % of the structural springs are elongated at most this much",
         .example = "0.05",
         .default_text = "not checked"}),
    row<&Scene::expect, &ExpectSection::lowest_y_m>({.section = "expect",
                                                     .key = "lowest_y",
                                                     .minimum = -1e6,
                                                     .maximum = 1e6,
                                                     .unit = "m",
                                                     .about = "no particle is lower",
                                                     .example = "0",
                                                     .default_text = "not checked"}),
    row<&Scene::expect, &ExpectSection::highest_y_m>({.section = "expect",
                                                      .key = "highest_y",
                                                      .minimum = -1e6,
                                                      .maximum = 1e6,
                                                      .unit = "m",
                                                      .about = "no particle is higher",
                                                      .example = "2",
                                                      .default_text = "not checked"}),
    row<&Scene::expect, &ExpectSection::energy_max_j>(
        {.section = "expect",
         .key = "energy_max_j",
         .minimum = -1e12,
         .maximum = 1e12,
         .unit = "J",
         .about = "kinetic, elastic, bending and gravity energy together are at most this",
         .example = "3",
         .default_text = "not checked"}),
    row<&Scene::expect, &ExpectSection::at_time_s>({.section = "expect",
                                                    .key = "at_time",
                                                    .maximum = 1e6,
                                                    .unit = "s",
                                                    .about = "when the checks are made",
                                                    .example = "5",
                                                    .default_text = "the end of the run"}),
};

}  // namespace

std::span<const Parameter> parameters() { return kTable; }

}  // namespace weft
