// Rows of the parameter table: what acts on the cloth. A new parameter is one member in scene.h and one row
// here.

#include "scene/parameter_access.h"
#include "scene/parameter_rows.h"
#include "scene/parameter_specials.h"

namespace weft {
namespace {

using namespace parameter_access;
using enum ParameterKind;

const Parameter kOutsideRows[] = {
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
    {.section = "spheres",
     .key = "keys",
     .kind = keys,
     .minimum = -kFarthest_m,
     .maximum = kFarthest_m,
     .unit = "m",
     .about = "places of its centre in time, in place of center and velocity",
     .example = "[{ time = 0, center = [0, 1, 0] }, { time = 2, center = [0, 0, 0] }]",
     .default_text = "none",
     .get = get_sphere_keys,
     .set = set_sphere_keys},

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
};

}  // namespace

std::span<const Parameter> parameter_access::outside_rows() { return kOutsideRows; }

}  // namespace weft
