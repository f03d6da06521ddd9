// The rows of the parameter table about what the cloth collides with.
#include "scene/parameter_access.h"
#include "scene/parameter_rows.h"
#include "scene/parameter_specials.h"

namespace weft {
namespace {

using namespace parameter_access;
using enum ParameterKind;

// What the bodies' rows have in common; `row` adds where the value is kept.

constexpr Parameter place_row(std::string_view section, std::string_view key, std::string_view about,
                              std::string_view example) {
  return {.section = section,
          .key = key,
          .kind = vec3,
          .minimum = -kFarthest_m,
          .maximum = kFarthest_m,
          .required = true,
          .unit = "m",
          .about = about,
          .example = example};
}

constexpr Parameter radius_row(std::string_view section, std::string_view about, std::string_view example) {
  return {.section = section,
          .key = "radius",
          .minimum = 1e-4,
          .maximum = 1000,
          .required = true,
          .slider_minimum = 0.02,
          .slider_maximum = 1,
          .unit = "m",
          .about = about,
          .example = example};
}

constexpr Parameter rotation_row(std::string_view section, std::string_view about) {
  return {.section = section,
          .key = "rotation",
          .kind = vec3,
          .minimum = -360,
          .maximum = 360,
          .slider_minimum = -180,
          .slider_maximum = 180,
          .unit = "°",
          .about = about,
          .example = "[0, 45, 0]"};
}

constexpr Parameter velocity_row(std::string_view section, std::string_view about) {
  return {.section = section,
          .key = "velocity",
          .kind = vec3,
          .minimum = -1000,
          .maximum = 1000,
          .unit = "m/s",
          .about = about,
          .example = "[0, 0, 1]"};
}

constexpr Parameter friction_row(std::string_view section) {
  return {.section = section,
          .key = "friction",
          .maximum = 100,
          .slider_maximum = 1,
          .about = "Coulomb coefficient",
          .example = "0.3"};
}

constexpr Parameter keys_row(std::string_view section, std::string_view about, std::string_view example) {
  return {.section = section,
          .key = "keys",
          .kind = keys,
          .minimum = -kFarthest_m,
          .maximum = kFarthest_m,
          .unit = "m",
          .about = about,
          .example = example,
          .default_text = "none"};
}

constexpr std::string_view kTurningKeys =
    "[{ time = 0, center = [0, 1, 0] }, { time = 2, center = [0, 0, 0], rotation = [0, 90, 0] }]";

constexpr Parameter sphere_keys_row() {
  Parameter parameter = keys_row("spheres", "places of its centre in time, in place of center and velocity",
                                 "[{ time = 0, center = [0, 1, 0] }, { time = 2, center = [0, 0, 0] }]");
  parameter.get = get_sphere_keys;
  parameter.set = set_sphere_keys;
  return parameter;
}

const Parameter kColliderRows[] = {
    row<&Scene::floor, &FloorSection::height_m>({.section = "floor",
                                                 .key = "height",
                                                 .minimum = -kFarthest_m,
                                                 .maximum = kFarthest_m,
                                                 .unit = "m",
                                                 .about = "level of the floor, where x = z = 0",
                                                 .example = "0"}),
    row<&Scene::floor, &FloorSection::normal>(
        {.section = "floor",
         .key = "normal",
         .kind = vec3,
         .minimum = -1,
         .maximum = 1,
         .slider_minimum = -1,
         .slider_maximum = 1,
         .about = "direction out of the floor, of any length; [0, 1, 0] is level",
         .example = "[0.2, 1, 0]"}),
    row<&Scene::floor, &FloorSection::friction>(friction_row("floor")),

    row<&Scene::spheres, &SphereSection::center_m>(
        place_row("spheres", "center", "middle of the sphere at the start", "[0, 0.5, 0]")),
    row<&Scene::spheres, &SphereSection::radius_m>(radius_row("spheres", "radius of the sphere", "0.25")),
    row<&Scene::spheres, &SphereSection::velocity_m_s>(
        velocity_row("spheres", "the sphere moves steadily with it")),
    row<&Scene::spheres, &SphereSection::friction>(friction_row("spheres")),
    sphere_keys_row(),

    row<&Scene::capsules, &CapsuleSection::a_m>(
        place_row("capsules", "a", "one end of its axis at the start", "[-0.5, 0.5, 0]")),
    row<&Scene::capsules, &CapsuleSection::b_m>(place_row("capsules", "b", "the other end", "[0.5, 0.5, 0]")),
    row<&Scene::capsules, &CapsuleSection::radius_m>(
        radius_row("capsules", "distance of its surface from the axis", "0.1")),
    row<&Scene::capsules, &SolidSection::velocity_m_s>(velocity_row("capsules", "it moves steadily with it")),
    row<&Scene::capsules, &SolidSection::friction>(friction_row("capsules")),
    row<&Scene::capsules, &SolidSection::keys>(keys_row(
        "capsules", "places of its middle in time, and what it is turned by (rotation), in place of velocity",
        kTurningKeys)),

    row<&Scene::boxes, &BoxSection::center_m>(
        place_row("boxes", "center", "middle of the box at the start", "[0, 0.5, 0]")),
    row<&Scene::boxes, &BoxSection::size_m>({.section = "boxes",
                                             .key = "size",
                                             .kind = vec3,
                                             .minimum = 1e-3,
                                             .maximum = 1000,
                                             .required = true,
                                             .slider_minimum = 0.02,
                                             .slider_maximum = 1,
                                             .unit = "m",
                                             .about = "whole edges along its own axes",
                                             .example = "[0.4, 0.2, 0.4]"}),
    row<&Scene::boxes, &BoxSection::rotation_deg>(
        rotation_row("boxes", "turned about x, then y, then z, through its middle")),
    row<&Scene::boxes, &SolidSection::velocity_m_s>(velocity_row("boxes", "it moves steadily with it")),
    row<&Scene::boxes, &SolidSection::friction>(friction_row("boxes")),
    row<&Scene::boxes, &SolidSection::keys>(
        keys_row("boxes",
                 "places of its middle in time, and what it is turned by (rotation), in place of center and "
                 "velocity",
                 kTurningKeys)),

    row<&Scene::meshes, &MeshSection::file>({.section = "meshes",
                                             .key = "file",
                                             .kind = word,
                                             .required = true,
                                             .about = "a closed OBJ mesh, named from the scene's folder",
                                             .example = "\"bowl.obj\""}),
    row<&Scene::meshes, &MeshSection::center_m>(
        place_row("meshes", "center", "where the file's origin is at the start", "[0, 0.5, 0]")),
    row<&Scene::meshes, &MeshSection::scale>({.section = "meshes",
                                              .key = "scale",
                                              .minimum = 1e-6,
                                              .maximum = 1e6,
                                              .slider_minimum = 0.1,
                                              .slider_maximum = 10,
                                              .slider_logarithmic = true,
                                              .unit = "m",
                                              .about = "length of one unit of the file",
                                              .example = "0.01 for a file in cm"}),
    row<&Scene::meshes, &MeshSection::rotation_deg>(
        rotation_row("meshes", "turned about x, then y, then z, through its origin")),
    row<&Scene::meshes, &MeshSection::resolution>(
        {.section = "meshes",
         .key = "resolution",
         .kind = integer,
         .minimum = 8,
         .maximum = 128,
         .slider_minimum = 8,
         .slider_maximum = 128,
         .about = "cells of its distance grid along the longest side",
         .example = "64"}),
    row<&Scene::meshes, &SolidSection::velocity_m_s>(velocity_row("meshes", "it moves steadily with it")),
    row<&Scene::meshes, &SolidSection::friction>(friction_row("meshes")),
    row<&Scene::meshes, &SolidSection::keys>(
        keys_row("meshes",
                 "places of its origin in time, and what it is turned by (rotation), in place of center and "
                 "velocity",
                 kTurningKeys)),

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
    row<&Scene::self_collision, &SelfCollisionSection::friction>(
        {.section = "self_collision",
         .key = "friction",
         .maximum = 100,
         .slider_maximum = 1,
         .about = "Coulomb coefficient between layers",
         .example = "0.3"}),

    row<&Scene::tethers, &TethersSection::slack>(
        {.section = "tethers",
         .key = "slack",
         .maximum = 10,
         .slider_maximum = 0.5,
         .about = "by how much of its length on the flat cloth a tether may be longer",
         .example = "0.02"}),

    row<&Scene::tearing, &TearingSection::strain>({.section = "tearing",
                                                   .key = "strain",
                                                   .minimum = 0.001,
                                                   .maximum = 10,
                                                   .required = true,
                                                   .slider_minimum = 0.02,
                                                   .slider_maximum = 1,
                                                   .slider_logarithmic = true,
                                                   .about = "elongation at which a link breaks for good",
                                                   .example = "0.3"}),
};

}  // namespace

std::span<const Parameter> parameter_access::collider_rows() { return kColliderRows; }

}  // namespace weft
