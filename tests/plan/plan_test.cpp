// The plan: goldens of the six scenes, and the law that what a scene does not call for is not in it.
#include "plan/plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "core/error.h"
#include "passes/passes.h"
#include "plan/buffers.h"
#include "scene/reader.h"

namespace weft {
namespace {

Model model_of(const std::string& text) { return build_model(parse_scene(text, "test.toml").scene); }

Plan plan_of(const std::string& text) { return compile_plan(model_of(text), find_solver("leapfrog")); }

bool constant_on(const Plan& plan, std::string_view name) {
  for (const PlanStep& step : plan.steps)
    for (const Constant& constant : step.constants)
      if (constant.name == name) return constant.value != 0;
  ADD_FAILURE() << "no constant " << name;
  return false;
}

std::string reason_for(const Plan& plan, std::string_view effect) {
  for (const LeftOut& left_out : plan.left_out)
    if (left_out.effect == effect) return left_out.reason;
  return "";
}

std::uint64_t bytes_of(const Plan& plan, BufferId id) {
  for (const PlanBuffer& buffer : plan.buffers)
    if (buffer.id == id) return buffer.bytes;
  return 0;
}

/// Run with WEFT_UPDATE_GOLDENS=1 to write them anew.
TEST(Plan, equals_its_golden_copy_for_each_scene) {
  for (const AssetInfo& asset : numbered_scenes()) {
    const Model model = build_model(load_scene(asset.file).scene);
    const std::string json = to_json(compile_plan(model, find_solver(model.scene.solver.name)), model) + "\n";
    const std::string file = std::string(WEFT_SOURCE_DIR "/tests/golden/plans/") + asset.name + ".json";
    if (std::getenv("WEFT_UPDATE_GOLDENS") != nullptr) std::ofstream(file) << json;
    std::stringstream golden;
    golden << std::ifstream(file).rdbuf();
    EXPECT_EQ(json, golden.str()) << file << " differs; WEFT_UPDATE_GOLDENS=1 writes it anew";
  }
}

TEST(Plan, is_substeps_then_the_closing_kick_then_normals_and_the_watch) {
  const Plan plan = plan_of("[cloth]\nresolution = 16\n[gravity]\n[solver]\nsubsteps = 50");
  ASSERT_EQ(plan.steps.size(), 6u);
  EXPECT_EQ(plan.steps[0].pass, &integrate);
  EXPECT_EQ(plan.steps[0].repeat, 50u);
  EXPECT_EQ(plan.steps[1].pass, &integrate);
  EXPECT_EQ(plan.steps[1].block, Block::frame_end);
  EXPECT_EQ(plan.steps[2].pass, &normals);
  EXPECT_EQ(plan.steps[3].pass, &watch);
  EXPECT_EQ(plan.steps[4].pass, &judge);
  EXPECT_EQ(plan.steps[5].pass, &keep_sound);
  EXPECT_EQ(plan.dispatches(), 55u);
}

/// Each row: what to add to a bare scene, and which constant and effect that is.
struct EffectCase {
  std::string_view constant, effect;
  std::string section;
};
const EffectCase kCases[] = {
    {"air", "air drag", "[air]\ndrag = 0.1\n"},
    {"wind", "wind", "[air]\ndrag = 0.1\n[wind]\nvelocity = [0.0, 0.0, 3.0]\n"},
    {"gravity", "gravity", "[gravity]\n"},
    {"floor", "floor contact", "[floor]\nheight = -3.0\n"},
    {"spheres", "sphere contact", "[[spheres]]\ncenter = [0.0, -3.0, 0.0]\nradius = 0.2\n"},
    {"pins", "pins", "[[pins]]\nat = [0.0, 0.0]\n"},
    {"bending", "bending", "[material]\nbend = 1e-5\n"},
};

TEST(Plan, leaves_out_what_the_scene_does_not_have_and_says_why) {
  const std::string bare = "[cloth]\nresolution = 8\n";
  const Plan without = plan_of(bare);
  for (const EffectCase& c : kCases) {
    const Plan with = plan_of(bare + c.section);
    EXPECT_FALSE(constant_on(without, c.constant)) << c.effect;
    EXPECT_NE(reason_for(without, c.effect), "") << c.effect;
    EXPECT_TRUE(constant_on(with, c.constant)) << c.effect;
    EXPECT_EQ(reason_for(with, c.effect), "") << c.effect;
  }
  EXPECT_EQ(reason_for(without, "wind"), "the scene has no [wind]");
}

TEST(Plan, says_which_material_key_turned_an_effect_off) {
  const Plan plan = plan_of("[cloth]\nresolution = 8\n[material]\nshear = 0.0\nflex = 0.0\ndamping = 0.0\n");
  EXPECT_EQ(reason_for(plan, "shear springs"), "material.shear is 0");
  EXPECT_EQ(reason_for(plan, "flex springs"), "material.flex is 0");
  EXPECT_EQ(reason_for(plan, "bending"), "material.bend is 0");
  EXPECT_EQ(reason_for(plan, "spring damping"), "material.damping is 0");
}

// A sphere is three vec4s a row (shared/params.h) in each of the two slots' tables: 50 substeps and a closing
// kick need 51 rows, rounded up to 64. An arithmetic effect takes nothing.
TEST(Plan, counts_no_byte_for_an_absent_effect) {
  const std::string bare = "[cloth]\nresolution = 8\n[solver]\nsubsteps = 50\n";
  const std::string sphere = "[[spheres]]\ncenter = [0.0, -3.0, 0.0]\nradius = 0.2\n";
  const std::uint64_t without = plan_of(bare).bytes();
  EXPECT_EQ(plan_of(bare + "[gravity]\n[air]\ndrag = 1.0\n[floor]\nheight = -3.0\n").bytes(), without);
  EXPECT_EQ(plan_of(bare + sphere).bytes(), without + 2 * 64 * 3 * 16);
  EXPECT_EQ(plan_of(bare + sphere + sphere).bytes(), without + 2 * 64 * 6 * 16);
}

TEST(Plan, sums_its_buffers) {
  const Plan plan = plan_of("[cloth]\nresolution = 10\nheight = 2.0\n[solver]\nsubsteps = 63\n");
  const std::uint64_t particles = 10 * 19;  // height 2 of width 1: 2·9 cells
  for (const BufferId id :
       {BufferId::position, BufferId::position_next, BufferId::velocity, BufferId::velocity_next,
        BufferId::normal, BufferId::kept_position, BufferId::kept_velocity})
    EXPECT_EQ(bytes_of(plan, id), 16 * particles);
  EXPECT_EQ(bytes_of(plan, BufferId::substeps), 2u * 64 * 2 * 16);
  EXPECT_EQ(bytes_of(plan, BufferId::params), 2 * sizeof(shared::Params));
  // 19 rows are two pieces a column of at most 16, three words each; five words of verdict.
  EXPECT_EQ(bytes_of(plan, BufferId::watch_parts), 3u * 4 * 10 * 2);
  EXPECT_EQ(bytes_of(plan, BufferId::watch_state), 5u * 4);
  EXPECT_EQ(plan.bytes(), 7 * 16 * particles + 2 * 64 * 2 * 16 + 2 * sizeof(shared::Params) + 240 + 20);
}

TEST(Plan, has_room_for_the_closing_kick_at_powers_of_two) {
  EXPECT_EQ(substep_row_capacity(2), 2u);
  EXPECT_EQ(substep_row_capacity(64), 64u);
  EXPECT_EQ(substep_row_capacity(65), 128u);
}

/// What a solver keeps beyond the state, and nobody else.
TEST(Plan, has_a_solvers_own_buffers_only_with_that_solver) {
  const Model model = model_of("[cloth]\nresolution = 8\n[material]\nbend = 1e-5\n[solver]\nsubsteps = 10\n");
  const std::map<std::string_view, std::set<BufferId>> own{
      {"velocity-verlet", {BufferId::half_velocity}},
      {"verlet", {BufferId::position_previous}},
      {"rk4",
       {BufferId::base_position, BufferId::base_velocity, BufferId::sum_position, BufferId::sum_velocity}},
      {"xpbd", {BufferId::constraints}}};
  for (const Solver* solver : solvers()) {
    const Plan plan = compile_plan(model, *solver);
    const auto keeps = own.find(solver->name);
    std::set<BufferId> beyond;
    for (const PlanBuffer& buffer : plan.buffers)
      if (buffer.id > BufferId::normal && buffer.id < BufferId::draw_position) beyond.insert(buffer.id);
    EXPECT_EQ(beyond, keeps == own.end() ? std::set<BufferId>{} : keeps->second) << solver->name;
    if (!has_compensated(*solver)) continue;
    const Plan compensated = compile_plan(model, *solver, "f32k");
    EXPECT_EQ(bytes_of(compensated, BufferId::compensation), 2 * 16 * model.grid.count()) << solver->name;
    EXPECT_EQ(compensated.bytes(), plan.bytes() + 2 * 16 * model.grid.count()) << solver->name;
  }
}

// docs/solvers.md "Precision": verlet borrows leapfrog's closing kick, which has a compensated form, and is
// refused all the same.
TEST(Plan, has_compensated_sums_for_three_solvers) {
  const Model model = model_of("[cloth]\nresolution = 8\n");
  const std::set<std::string_view> able{"leapfrog", "symplectic-euler", "velocity-verlet"};
  for (const Solver* solver : solvers()) {
    EXPECT_EQ(has_compensated(*solver), able.contains(solver->name)) << solver->name;
    if (!able.contains(solver->name)) {
      EXPECT_THROW(compile_plan(model, *solver, "f32k"), Error);
    }
  }
}

/// Double costs twice the bytes of what it computes, one pass and two buffers of floats to draw from; and the
/// other precisions have none of it.
TEST(Plan, has_what_is_drawn_in_float_only_in_double) {
  const Model model = model_of("[cloth]\nresolution = 8\n[gravity]\n[solver]\nsubsteps = 50\n");
  const std::uint64_t particles = model.grid.count();
  const auto presents = [](const Plan& plan) {
    return std::ranges::count(plan.steps, &present, &PlanStep::pass);
  };
  for (const Solver* solver : solvers()) {
    const Plan in_float = compile_plan(model, *solver, "f32"),
               in_double = compile_plan(model, *solver, "f64");
    EXPECT_EQ(presents(in_float), 0) << solver->name;
    EXPECT_EQ(bytes_of(in_float, BufferId::draw_position), 0u) << solver->name;
    EXPECT_EQ(presents(in_double), 1) << solver->name;
    EXPECT_EQ(in_double.dispatches(), in_float.dispatches() + 1) << solver->name;
    const std::uint64_t params = bytes_of(in_float, BufferId::params),
                        params_in_double = 2 * sizeof(shared::ParamsOf<double>);
    const std::uint64_t words =
        bytes_of(in_float, BufferId::watch_parts) + bytes_of(in_float, BufferId::watch_state);
    EXPECT_EQ(in_double.bytes(),
              2 * (in_float.bytes() - params - words) + words + params_in_double + 2 * 16 * particles)
        << solver->name;
  }
  EXPECT_EQ(presents(compile_plan(model, find_solver("leapfrog"), "f32k")), 0);
}

// Twelve colours of springs and six of bending triples, between a prediction and the velocities; a kind of
// spring that the material does not have is not in the plan.
TEST(Plan, of_xpbd_has_a_step_for_each_colour_there_is) {
  const auto steps_of = [](const std::string& material) {
    const Model model = model_of("[cloth]\nresolution = 8\n[material]\n" + material);
    const Plan plan = compile_plan(model, find_solver("xpbd"));
    EXPECT_EQ(plan.substeps, 20u);
    std::uint64_t springs = 0;
    for (const PlanStep& step : plan.steps) springs += step.spring_evaluations;
    EXPECT_EQ(springs, model.spring_count);  // each once, whatever its colour
    return plan.steps.size();
  };
  EXPECT_EQ(steps_of("bend = 1e-5\n"), 2u + 12 + 6 + 4);
  EXPECT_EQ(steps_of("bend = 0.0\n"), 2u + 12 + 4);
  EXPECT_EQ(steps_of("shear = 0.0\n"), 2u + 8 + 4);
  EXPECT_EQ(steps_of("shear = 0.0\nflex = 0.0\n"), 2u + 4 + 4);
}

// A Runge-Kutta stage is a row of the table: 4 x 50 and a closing one need 256.
TEST(Plan, has_a_row_of_the_table_for_each_stage) {
  const Model model = model_of("[cloth]\nresolution = 8\n[solver]\nsubsteps = 50\n");
  EXPECT_EQ(bytes_of(compile_plan(model, find_solver("rk4")), BufferId::substeps), 2u * 256 * 2 * 16);
  EXPECT_EQ(bytes_of(compile_plan(model, find_solver("trapezoid")), BufferId::substeps), 2u * 128 * 2 * 16);
  EXPECT_EQ(compile_plan(model, find_solver("rk4")).dispatches(), 4u * 50 + 4);
}

const char* const kSelfCollision =
    "[cloth]\nresolution = 8\n[solver]\nsubsteps = 50\n[self_collision]\nthickness = 0.1\n";

/// Passes and bytes that self-collision brings are in the plan of a scene that asks for it, and in no other.
TEST(Plan, has_self_collision_s_passes_and_bytes_only_where_the_scene_asks) {
  const Plan with = plan_of(kSelfCollision),
             without = plan_of("[cloth]\nresolution = 8\n[solver]\nsubsteps = 50\n");
  const std::vector<const Pass*> own = {&carry,          &pair_check,   &cell_count,    &cell_scan,
                                        &cell_fill,      &cell_sort,    &patch_near,    &pair_gather,
                                        &surface_gather, &touch_weight, &surface_touch, &surface_contact,
                                        &self_contact};
  for (const PlanStep& step : without.steps)
    EXPECT_EQ(std::ranges::count(own, step.pass), 0) << step.pass->name;
  for (const PlanBuffer& buffer : without.buffers)
    EXPECT_TRUE(buffer.id <= BufferId::normal ||
                (buffer.id >= BufferId::watch_parts && buffer.id <= BufferId::kept_velocity));
  EXPECT_EQ(reason_for(without, "self-collision"), "the scene has no [self_collision]");
  EXPECT_EQ(reason_for(with, "self-collision"), "");

  ASSERT_EQ(with.steps.size(),
            without.steps.size() + own.size() + 2);  // carry and pair_check at the frame's end
  for (std::size_t k = 0; k < own.size(); ++k) EXPECT_EQ(with.steps[k].pass, own[k]);
  std::uint64_t brought = 0;
  for (const PlanBuffer& buffer : with.buffers)
    if (bytes_of(without, buffer.id) == 0) brought += buffer.bytes;
  EXPECT_EQ(with.bytes(), without.bytes() + brought);
}

/// In substeps 0, k, 2k, …: ⌈50/k⌉ times a frame.
TEST(Plan, runs_self_collision_in_every_so_many_substeps) {
  const Model model = model_of(kSelfCollision);
  const Plan plan = compile_plan(model, find_solver("leapfrog"));
  const std::uint32_t interval = plan.steps[0].interval;
  EXPECT_EQ(interval, 16u);  // at 1 m/s in 50 mm of 0.33 ms steps: 150, cut to the most there is
  EXPECT_EQ(plan.steps[0].repeat, 4u);
  EXPECT_EQ(nlohmann::json::parse(to_json(plan, model))["steps"][0]["interval"], interval);
}

/// Motion is looked at in every substep of so thin a cloth, its lists are made in some: the text names which.
TEST(Plan, says_which_passes_some_substeps_are_without) {
  const Model model = model_of(
      "[cloth]\nresolution = 64\n[gravity]\n[self_collision]\nthickness = 0.001\n[solver]\nsubsteps = 200\n");
  const Plan plan = compile_plan(model, find_solver("leapfrog"));
  const auto interval_of = [&](const Pass& pass) {
    return std::ranges::find(plan.steps, &pass, &PlanStep::pass)->interval;
  };
  const std::uint32_t looks = interval_of(pair_check), lists = interval_of(cell_count);
  ASSERT_NE(looks, lists);
  const std::string text = describe(plan, model);
  EXPECT_NE(text.find(fmt::format("Substeps 0, {}, {}, ... alone have cell_count, ", lists, 2 * lists)),
            std::string::npos);
  EXPECT_EQ(text.find("alone have carry") != std::string::npos, looks > 1);
}

TEST(Plan, refuses_self_collision_with_solvers_that_have_no_passes_for_it) {
  const Model model = model_of(kSelfCollision);
  for (const Solver* solver : solvers()) {
    if (solver->name == "leapfrog") continue;
    try {
      compile_plan(model, *solver);
      FAIL() << solver->name;
    } catch (const Error& refusal) {
      EXPECT_EQ(refusal.code(), Exit::usage);
      EXPECT_NE(std::string(refusal.what()).find(solver->name), std::string::npos);
    }
  }
}

// What concerns two sections names the line of the one that has to go, or the --set that gave it.
TEST(Plan, refusals_of_two_sections_name_a_line) {
  const auto refusal = [](const std::string& text, const SceneOverrides& overrides = {}) {
    try {
      const Model model = build_model(parse_scene(text, "scene.toml", overrides).scene);
      compile_plan(model, find_solver(model.scene.solver.name), model.scene.solver.precision);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("not refused");
  };
  const std::string two = "[cloth]\nresolution = 12\n[[cloths]]\ncenter = [0, 1, 0]\n[[pins]]\nat = [0, 0]\n";
  const std::string one = "[cloth]\nresolution = 12\n", rk4 = "[solver]\nname = \"rk4\"\n";
  const std::string xpbd = "[solver]\nname = \"xpbd\"\n";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {refusal(two + "[tearing]\nstrain = 0.5\n"), "scene.toml:7: [tearing] stands beside [[cloths]]"},
      {refusal(two, {{"tearing.strain=0.5"}}), "--set tearing.strain=0.5: [tearing] stands beside"},
      {refusal(two + xpbd + "[tethers]\n"), "scene.toml:9: [tethers] stands beside [[cloths]]"},
      {refusal(one + "[material]\nstrain_limit = 0.1\n[tearing]\nstrain = 0.5\n"),
       "scene.toml:5: [tearing] stands beside material.strain_limit"},
      {refusal(one + rk4 + "[self_collision]\nthickness = 0.01\n"), "scene.toml:5: [self_collision] with"},
      {refusal(one + rk4 + "[material]\ndamping = 0\nstrain_limit = 0.1\n"),
       "scene.toml:7: material.strain_limit is 0.1"},
      {refusal(one + "[floor]\nnormal = [0.1, 1, 0]\n" + rk4), "scene.toml:4: [[capsules]], [[boxes]] or"},
      {refusal(one + rk4 + "[[boxes]]\ncenter = [0, -9, 0]\nsize = [1, 1, 1]\n"), "scene.toml:5: [[caps"},
      {refusal(one + rk4 + "[aerodynamics]\n"), "scene.toml:5: [aerodynamics]"},
      {refusal(one + "[[pins]]\nat = [0, 0]\n[tethers]\n"), "scene.toml:5: [tethers] with slack 0"},
      {refusal(one + xpbd + "[tethers]\n"), "scene.toml:5: [tethers] has nothing to hold on to"},
      {refusal(one + rk4 + "precision = \"f32k\"\n"), "scene.toml:5: solver.precision is f32k"},
      {refusal(one + "[self_collision]\nfriction = 0\nthickness = 0.99\n[solver]\nsubsteps = 9\n"),
       "scene.toml:5: self_collision.thickness is 0.99"},
  };
  for (const auto& [said, beginning] : cases)
    EXPECT_TRUE(said.starts_with(beginning)) << said << "\nis to begin: " << beginning;
}

TEST(Plan, as_json_carries_the_documented_keys_and_the_same_numbers) {
  const Model model = model_of("[cloth]\nresolution = 12\n[gravity]\n");
  const Plan plan = compile_plan(model, find_solver("leapfrog"));
  const auto json = nlohmann::json::parse(to_json(plan, model));
  for (const char* key : {"steps", "buffers", "left_out", "bytes"}) EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["bytes"], plan.bytes());
  EXPECT_EQ(json["steps"][0]["pass"], "integrate");
  EXPECT_EQ(json["steps"][0]["repeat"], plan.substeps);
  EXPECT_EQ(json["steps"][0]["range"], nlohmann::json({12, 12}));
  EXPECT_EQ(json["steps"][0]["constants"]["gravity"], true);
  EXPECT_EQ(json["steps"][0]["constants"]["wind"], false);
}

TEST(Plan, for_people_names_every_buffer_and_every_omission) {
  const Model model = model_of("[cloth]\nresolution = 12\n[gravity]\n");
  const Plan plan = compile_plan(model, find_solver("leapfrog"));
  const std::string text = describe(plan, model);
  for (const PlanBuffer& buffer : plan.buffers)
    EXPECT_NE(text.find(row_of(buffer.id).name), std::string::npos) << row_of(buffer.id).name;
  for (const LeftOut& left_out : plan.left_out)
    EXPECT_NE(text.find(left_out.reason), std::string::npos) << left_out.effect;
}

}  // namespace
}  // namespace weft
