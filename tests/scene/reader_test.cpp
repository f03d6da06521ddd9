// The reader gives the documented defaults, and refuses a bad file with line, key, value, rule and cure.
#include "scene/reader.h"

#include "scene/scene_text.h"

namespace weft {
namespace {

TEST(Reader, DefaultsAreThoseOfTheFormat) {
  const Scene scene = read("[cloth]\n").scene;
  EXPECT_EQ(scene.cloth.width_m, 1.0);
  EXPECT_EQ(scene.cloth.height_m, 1.0);
  EXPECT_EQ(scene.cloth.resolution, 64u);
  EXPECT_EQ(scene.cloth.orientation, Orientation::vertical);
  EXPECT_EQ(scene.cloth.center_m, glm::dvec3(0.0));
  EXPECT_EQ(scene.cloth.imperfection_m, 0.0);
  EXPECT_EQ(scene.material.density_kg_m2, 0.2);
  EXPECT_EQ(scene.material.membrane_n_m, 1000.0);
  EXPECT_EQ(scene.material.shear(), 375.0);
  EXPECT_EQ(scene.material.flex, 0.25);
  EXPECT_EQ(scene.material.bend_n_m, 0.0);
  EXPECT_EQ(scene.material.damping_s, 1e-4);
  EXPECT_EQ(scene.material.damping_ratio_max, 0.1);
  EXPECT_EQ(scene.solver.name, "leapfrog");
  EXPECT_EQ(scene.solver.substeps, 0u);
  EXPECT_EQ(scene.solver.precision, "f32");
  EXPECT_EQ(scene.solver.frame_s, 1.0 / 60.0);
  EXPECT_TRUE(scene.pins.empty() && scene.spheres.empty());
  EXPECT_FALSE(scene.gravity || scene.air || scene.wind || scene.floor || scene.self_collision ||
               scene.expect);
}

TEST(Reader, DefaultsOfSectionsThatArePresent) {
  const Scene scene = read(R"(
[cloth]
[gravity]
[air]
drag = 0.1
[wind]
velocity = [0, 0, 3]
[floor]
[[pins]]
at = [0, 0]
[[spheres]]
center = [0, 9, 0]
radius = 1
[expect]
)")
                          .scene;
  EXPECT_EQ(scene.gravity->acceleration_m_s2, glm::dvec3(0.0, -9.81, 0.0));
  EXPECT_EQ(scene.wind->gust, 0.0);
  EXPECT_EQ(scene.floor->height_m, 0.0);
  EXPECT_EQ(scene.floor->friction, 0.0);
  EXPECT_EQ(scene.pins.at(0).radius_m, 0.05);
  EXPECT_EQ(scene.spheres.at(0).velocity_m_s, glm::dvec3(0.0));
  EXPECT_EQ(scene.spheres.at(0).friction, 0.0);
  EXPECT_TRUE(scene.expect && !scene.expect->max_stretch && !scene.expect->at_time_s);
}

TEST(Reader, ReadsEveryKeyIntoItsPlace) {
  const Scene scene = read(R"(
title = "All"
[cloth]
width = 2
height = 3.0
resolution = 5
orientation = "horizontal"
center = [1, 2.5, -3]
imperfection = 0.01
[material]
density = 0.3
membrane = 10
shear = 4
flex = 0.5
bend = 1e-5
damping = 0
damping_ratio_max = 0.2
[[pins]]
at = [1, 0.5]
radius = 0.6
[self_collision]
thickness = 0.004
[solver]
name = "rk4"
substeps = 12
precision = "f64"
frame = 0.01
[expect]
max_stretch = 0.1
p99_stretch = 0.05
lowest_y = -1
highest_y = 4
energy_max_j = 7
at_time = 2
)")
                          .scene;
  EXPECT_EQ(scene.title, "All");
  EXPECT_EQ(scene.cloth.width_m, 2.0);
  EXPECT_EQ(scene.cloth.orientation, Orientation::horizontal);
  EXPECT_EQ(scene.cloth.center_m, glm::dvec3(1.0, 2.5, -3.0));
  EXPECT_EQ(scene.material.shear(), 4.0);
  EXPECT_EQ(scene.material.damping_ratio_max, 0.2);
  EXPECT_EQ(scene.pins.at(0).at, glm::dvec2(1.0, 0.5));
  EXPECT_EQ(scene.self_collision->thickness_m, 0.004);
  EXPECT_EQ(scene.solver.substeps, 12u);
  EXPECT_EQ(scene.solver.precision, "f64");
  EXPECT_EQ(scene.solver.frame_s, 0.01);
  EXPECT_EQ(scene.expect->max_stretch, 0.1);
  EXPECT_EQ(scene.expect->p99_stretch, 0.05);
  EXPECT_EQ(scene.expect->lowest_y_m, -1.0);
  EXPECT_EQ(scene.expect->highest_y_m, 4.0);
  EXPECT_EQ(scene.expect->energy_max_j, 7.0);
  EXPECT_EQ(scene.expect->at_time_s, 2.0);
}

TEST(Reader, ShearFollowsMembraneUnlessGiven) {
  EXPECT_EQ(read("[cloth]\n[material]\nmembrane = 80\n").scene.material.shear(), 30.0);
}

TEST(Reader, RefusalNamesLineKeyValueRuleAndCure) {
  EXPECT_EQ(
      refusal("title = \"x\"\n\n[cloth]\n\nresolution = 1\n"),
      "scene.toml:5: cloth.resolution is 1; it must be 2 to 4096, a whole number (40 runs on any machine)");
  EXPECT_EQ(refusal("[cloth]\nwidth = \"wide\"\n"),
            "scene.toml:2: cloth.width is \"wide\"; it must be 0.001 to 1000, in m (a flag: 1.5)");
}

TEST(Reader, ReportsTheFirstMistakeOfTheFile) {
  expect_refused("[solver]\nframe = -1\n[cloth]\nwidth = -1\n", {"scene.toml:2: solver.frame"});
}

TEST(Reader, UnknownNamesSuggestTheNearest) {
  expect_refused("[cloth]\nresolutoin = 5\n",
                 {"scene.toml:2", "\"resolutoin\"", "[cloth]", "did you mean resolution?"});
  expect_refused("[cloth]\n[matrial]\n", {"scene.toml:2", "\"matrial\"", "did you mean material?"});
  expect_refused("[cloth]\n[self-collision]\nthickness=1\n", {"did you mean self_collision?"});
  expect_refused("[cloth]\ncolour = 1\n", {"there are width, height"});
  expect_refused("[cloth]\n[[pins]]\nat = [0,0]\nraduis = 1\n", {"scene.toml:4", "did you mean radius?"});
  expect_refused("cloth.width = 1\ntitel = 'x'\n", {"scene.toml:2", "did you mean title?"});
}

TEST(Reader, RefusesWrongShapes) {
  expect_refused("", {"no [cloth]"});
  expect_refused("[material]\n", {"no [cloth]"});
  expect_refused("cloth = 3\n", {"scene.toml:1", "must be a section, written [cloth]"});
  expect_refused("[[cloth]]\n", {"a list of sections"});
  expect_refused("[cloth]\n[pins]\nat = [0,0]\n", {"scene.toml:2", "each written [[pins]]"});
  expect_refused("[cloth]\nwidth = [1]\n", {"cloth.width is [1]"});
  expect_refused("[cloth]\ncenter = [0, 1]\n", {"cloth.center is [0, 1]", "three numbers"});
  expect_refused("[cloth]\ncenter = [0, 1, \"a\"]\n", {"cloth.center"});
  expect_refused("[cloth]\nwidth = 1979-05-27\n", {"a date or time"});
  expect_refused("[cloth]\nwidth = true\n", {"cloth.width is true"});
  expect_refused("[cloth.width]\nx = 1\n", {"cloth.width is a table"});
  expect_refused("[cloth]\nresolution = 40.5\n", {"a whole number"});
  expect_refused("[cloth]\norientation = \"diagonal\"\n", {"\"diagonal\"", "\"vertical\" or \"horizontal\""});
  expect_refused("[cloth]\n[solver]\nsubsteps = \"many\"\n", {"1 to 1e+06, a whole number, or \"auto\""});
  expect_refused("[cloth]\n[solver]\nsubsteps = 0\n", {"solver.substeps is 0"});
}

TEST(Reader, SyntaxMistakesCarryTheirLine) {
  expect_refused("[cloth]\nwidth = \n",
                 {"scene.toml:2: \"width = \"", "not TOML", "write [section], key = 1.5"});
  expect_refused("[cloth]\nwidth = 1\nwidth = 2\n", {"scene.toml:3", "width"});
  expect_refused("[cloth]\n[gravity]\n[cloth]\n", {"scene.toml:3"});
  expect_refused("[cloth]\nwidth = 1 2\n", {"scene.toml:2"});
}

// toml++ 3.3 runs into undefined behaviour on these; they must not reach it.
TEST(Reader, WhatTheParserCannotBearIsRefusedBeforeIt) {
  for (const char* text : {"[\ncloth]\n", "[", "[[\ncloth]]", "[ #\n", "\n\n[=\n", "[cloth]\n [\x01]"})
    expect_refused(text, {"not TOML", "name must follow"});
  expect_refused("v=[}", {"scene.toml:1", "closes no"});
  expect_refused("[cloth]\ncenter = [1,\n}", {"scene.toml:3", "closes no"});
  expect_refused("[cloth]\nwidth = 1µ\n", {"scene.toml:2", "in quotes and comments"});
  expect_refused("\"a\" = '\"'\n\nwidthШ = 1\n", {"scene.toml:3", "in quotes and comments"});
  expect_refused("title = '''\n[\n'''\nµ", {"scene.toml:4", "in quotes and comments"});
}

TEST(Reader, OtherLettersMayStandInTextAndComments) {
  const Scene scene = read("\xEF\xBB\xBF# µ ['''\n[cloth] # é\n[[pins]]\nat = [\n  0, # [\n  0]\n").scene;
  EXPECT_EQ(scene.pins.size(), 1u);
  EXPECT_EQ(read("title = \"Stoff für \\\"µ\\\" [\"\n[cloth]\n").scene.title, "Stoff für \"µ\" [");
  EXPECT_EQ(read("title = '''\n[ µ'''''\n[cloth]\n").scene.title, "[ µ''");
  EXPECT_EQ(read("title = \"\"\"a\"\"é\\\"\"\"\"  # µ\n[cloth]\n").scene.title, "a\"\"é\"");
}

TEST(Reader, ASceneWithoutATitleHasItsFilesName) {
  EXPECT_EQ(read("[cloth]\n").scene.title, "scene");
  EXPECT_EQ(read("title = \"\"\n[cloth]\n").scene.title, "scene");
}

TEST(Reader, ATitleIsOnePrintableLine) {
  for (const char* text : {"a\\nb", "a\\tb", "\\u001b[2J", "\\u007f", "\\u009b1m"})
    expect_refused(fmt::format("title = \"{}\"\n[cloth]\n", text), {"scene.toml:1: title is", "printable"});
  EXPECT_EQ(read("title = \"é\\u00a0°\"\n[cloth]\n").scene.title, "é\u00a0°");
}

TEST(Reader, AWholeNumberHasNoPoint) {
  expect_refused("[cloth]\nresolution = 8.0\n",
                 {"scene.toml:2: cloth.resolution is 8.0; ", "a whole number"});
  expect_refused("[cloth]\n[solver]\nsubsteps = 1e2\n", {"solver.substeps is 100.0; "});
}

TEST(Reader, AWrongWordHasItsLineAndTheNearestWord) {
  expect_refused("[cloth]\n[solver]\nname = \"leepfrog\"\n",
                 {"scene.toml:3: solver.name is \"leepfrog\"", "\"rk4\"", "did you mean leapfrog?"});
  expect_refused("[cloth]\n[solver]\nprecision = \"f23\"\n",
                 {"scene.toml:3: solver.precision", "did you mean"});
}

TEST(Reader, RequiredKeysAreAskedFor) {
  expect_refused("[cloth]\n[air]\n", {"scene.toml:2: air.drag is missing", "0.1"});
  expect_refused("[cloth]\n[air]\ndrag=1\n[wind]\n", {"scene.toml:4: wind.velocity is missing"});
  expect_refused("[cloth]\n[[pins]]\n", {"scene.toml:2: pins.0.at is missing"});
  expect_refused("[cloth]\n[[spheres]]\nradius=1\n", {"scene.toml:2: spheres.0.center is missing"});
  expect_refused("[cloth]\n[[spheres]]\ncenter=[0,0,0]\n", {"spheres.0.radius is missing"});
  expect_refused("[cloth]\n[self_collision]\n", {"self_collision.thickness is missing"});
}

TEST(Reader, PresetGivesWayToKeysBesideIt) {
  const Scene scene = read("[cloth]\n[material]\nbend = 1e-6\npreset = \"denim\"\n").scene;
  EXPECT_EQ(scene.material.preset, "denim");
  EXPECT_EQ(scene.material.density_kg_m2, 0.324);  // the preset's
  EXPECT_EQ(scene.material.bend_n_m, 1e-6);        // the scene's, though written before
  EXPECT_EQ(read("material.preset = \"denim\"\n[cloth]\n").scene.material.density_kg_m2, 0.324);
  expect_refused("[cloth]\n[material]\npreset = \"denin\"\n", {"scene.toml:3", "did you mean denim?"});
  expect_refused("[cloth]\n[material]\npreset = \"../scenes/4-falling\"\n",
                 {"must be a name in assets/materials"});
}

// The preset speaks of warp and weft; what the scene says of both overrides it, what it says of one stays.
TEST(Reader, MembraneOverridesThePresetsWarpAndWeft) {
  const MaterialSection denim = read("[cloth]\n[material]\npreset = \"denim\"\n").scene.material;
  EXPECT_GT(denim.membrane_warp(), 5.0 * denim.membrane_weft());
  const auto with = [](const std::string& keys) {
    return read("[cloth]\n[material]\n" + keys + "preset = \"denim\"\n").scene.material;
  };
  EXPECT_EQ(with("membrane = 500\n").membrane_warp(), 500.0);
  EXPECT_EQ(with("membrane = 500\n").membrane_weft(), 500.0);
  EXPECT_EQ(with("membrane = 500\nmembrane_warp = 700\n").membrane_warp(), 700.0);
  EXPECT_EQ(with("membrane_warp = 700\n").membrane_weft(), denim.membrane_weft());
  EXPECT_EQ(with("bend = 1e-6\n").bend_weft(), 1e-6);
  EXPECT_EQ(
      read("[cloth]\n", {"material.preset=denim", "material.membrane=300"}).scene.material.membrane_warp(),
      300.0);
}

}  // namespace
}  // namespace weft
