// Rows of the parameter table: how time is stepped and what a scene expects of itself. A new parameter is one
// member in scene.h and one row here.

#include "scene/parameter_access.h"
#include "scene/parameter_rows.h"
#include "scene/parameter_specials.h"

namespace weft {
namespace {

using namespace parameter_access;
using enum ParameterKind;

// The solvers of src/solvers, which lies above this folder; its tests hold the two lists together.
constexpr std::string_view kSolverNames =
    "leapfrog|velocity-verlet|symplectic-euler|verlet|euler|trapezoid|rk4|xpbd";

const Parameter kRunRows[] = {
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

std::span<const Parameter> parameter_access::run_rows() { return kRunRows; }

}  // namespace weft
