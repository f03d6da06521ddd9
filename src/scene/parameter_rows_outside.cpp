// Rows of the parameter table: what acts on the cloth. A new parameter is one member in scene.h and one row
// here.

#include "scene/parameter_access.h"
#include "scene/parameter_rows.h"

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

    row<&Scene::wind, &WindSection::noise_m_s>(
        {.section = "wind",
         .key = "noise",
         .maximum = 1000,
         .slider_maximum = 10,
         .unit = "m/s",
         .about = "its components differ by up to this from place to place; needs [aerodynamics]",
         .example = "2"}),
    row<&Scene::wind, &WindSection::noise_scale_m>({.section = "wind",
                                                    .key = "noise_scale",
                                                    .minimum = 0.01,
                                                    .maximum = 1000,
                                                    .slider_minimum = 0.1,
                                                    .slider_maximum = 10,
                                                    .slider_logarithmic = true,
                                                    .unit = "m",
                                                    .about = "size of the eddies",
                                                    .example = "0.5"}),
    row<&Scene::wind, &WindSection::noise_period_s>({.section = "wind",
                                                     .key = "noise_period",
                                                     .minimum = 0.001,
                                                     .maximum = 1e6,
                                                     .slider_minimum = 0.1,
                                                     .slider_maximum = 10,
                                                     .slider_logarithmic = true,
                                                     .unit = "s",
                                                     .about = "time in which they become others",
                                                     .example = "1"}),
    row<&Scene::wind, &WindSection::seed>({.section = "wind",
                                           .key = "seed",
                                           .kind = integer,
                                           .maximum = 1e6,
                                           .about = "another number is other noise; the same number the same",
                                           .example = "1"}),

    row<&Scene::aerodynamics, &AerodynamicsSection::density_kg_m3>({.section = "aerodynamics",
                                                                    .key = "density",
                                                                    .maximum = 2000,
                                                                    .slider_maximum = 3,
                                                                    .unit = "kg/m³",
                                                                    .about = "of the air",
                                                                    .example = "1.2; water: 1000"}),
    row<&Scene::aerodynamics, &AerodynamicsSection::drag>({.section = "aerodynamics",
                                                           .key = "drag",
                                                           .maximum = 10,
                                                           .slider_maximum = 3,
                                                           .about = "coefficient of the force along the flow",
                                                           .example = "a flat plate: 1.28"}),
    row<&Scene::aerodynamics, &AerodynamicsSection::lift>(
        {.section = "aerodynamics",
         .key = "lift",
         .maximum = 10,
         .slider_maximum = 3,
         .about = "coefficient of the force across the flow",
         .example = "0.5"}),
};

}  // namespace

std::span<const Parameter> parameter_access::outside_rows() { return kOutsideRows; }

}  // namespace weft
