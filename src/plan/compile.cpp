// Model × Solver → Plan: which steps, over what, with which constants; the buffers they need; what was
// left out and why.
#include <algorithm>
#include <array>
#include <set>

#include "core/error.h"
#include "passes/integrate.h"
#include "passes/passes.h"
#include "passes/reach.h"
#include "passes/strain_limit.h"
#include "plan/buffers.h"
#include "plan/plan.h"
#include "plan/spread_frame.h"

namespace weft {
namespace {

std::string absent_section(std::string_view section) { return fmt::format("the scene has no {}", section); }

struct Effect {
  std::string_view constant, name;
  std::string (*reason)(const Scene&);
};

/// Why an effect's constant is off, in the order of the constants.
const Effect kEffects[] = {
    {"shear", "shear springs", [](const Scene&) { return std::string("material.shear is 0"); }},
    {"flex", "flex springs", [](const Scene&) { return std::string("material.flex is 0"); }},
    {"bending", "bending", [](const Scene&) { return std::string("material.bend is 0"); }},
    {"damping", "spring damping",
     [](const Scene& s) {
       return std::string(s.material.damping_s == 0 ? "material.damping is 0"
                                                    : "material.damping_ratio_max is 0");
     }},
    {"air", "air drag",
     [](const Scene& s) { return s.air ? std::string("air.drag is 0") : absent_section("[air]"); }},
    {"wind", "wind",
     [](const Scene& s) {
       if (!s.wind) return absent_section("[wind]");
       return std::string(s.air && s.air->drag_kg_m2_s > 0 ? "wind.velocity is 0" : "air.drag is 0");
     }},
    {"gravity", "gravity",
     [](const Scene& s) {
       return s.gravity ? std::string("gravity.acceleration is 0") : absent_section("[gravity]");
     }},
    {"floor", "floor contact", [](const Scene&) { return absent_section("[floor]"); }},
    {"spheres", "sphere contact", [](const Scene&) { return absent_section("[[spheres]]"); }},
    {"pins", "pins", [](const Scene&) { return absent_section("[[pins]]"); }},
};

std::vector<LeftOut> left_out_effects(const Model& model) {
  const Constants effects = integrate_constants(model);
  std::vector<LeftOut> left_out;
  for (const Effect& effect : kEffects) {
    if (effect.constant == "floor" && has_tilted_floor(model)) continue;  // solid_contact holds it
    for (const Constant& constant : effects)
      if (constant.name == effect.constant && constant.value == 0)
        left_out.push_back({effect.name, effect.reason(model.scene)});
  }
  if (!has_strain_limit(model)) left_out.push_back({"strain limit", "material.strain_limit is 0"});
  if (!model.scene.self_collision) left_out.push_back({"self-collision", absent_section("[self_collision]")});
  return left_out;
}

std::vector<PlanBuffer> buffers_for(const Model& model, const Plan& plan) {
  std::set<BufferId> needed;
  for (const PlanStep& step : plan.steps) {
    const auto touched = buffers_of(*step.pass);
    needed.insert(touched.begin(), touched.end());
  }
  if (plan.reaching.asked()) needed.insert(BufferId::reach_groups);
  if (plan.spreads) needed.insert(BufferId::spread_state);
  std::vector<PlanBuffer> buffers;
  buffers.reserve(needed.size());
  for (const BufferId id : needed)
    buffers.push_back({id, slot_bytes(id, model, plan.row_count(), plan.in_double()) * slot_count(id)});
  return buffers;
}

/// What every plan ends its frames with, whatever the solver.
constexpr std::array kEveryFrame{SolverStep{&watch, Block::frame_end}, SolverStep{&judge, Block::frame_end},
                                 SolverStep{&keep_sound, Block::frame_end}};

std::vector<PlanStep> steps_for(const Model& model, const Solver& solver, std::uint32_t substeps,
                                bool compensated) {
  std::vector<PlanStep> steps;
  const auto put = [&](const Pass& plain, const SolverStep& step) {
    const Pass& pass = compensated && plain.compensated ? *plain.compensated : plain;
    const Range range = pass.item_domain ? pass.item_domain(model, step.item) : pass.domain(model);
    if (range.empty()) return;
    const std::uint64_t springs = pass.item_spring_evaluations
                                      ? pass.item_spring_evaluations(model, step.item)
                                      : pass.spring_evaluations(model);
    const bool sparse = step.block == Block::substep && pass.interval != nullptr;
    const std::uint32_t interval = sparse ? pass.interval(model, model.scene.solver.frame_s / substeps) : 1;
    const std::uint32_t repeat = step.block == Block::substep ? (substeps - 1) / interval + 1 : 1;
    steps.push_back(
        {&pass, step.block, repeat, range, pass.constants(model), step.row, step.item, springs, interval});
  };
  const auto add = [&](const SolverStep& step) {
    const bool tears = model.scene.tearing.has_value();
    if (tears && step.pass->once_torn) put(*step.pass->once_torn, step);
    put(tears && step.pass->torn ? *step.pass->torn : *step.pass, step);
  };
  for (const Block block : {Block::frame_start, Block::substep, Block::frame_end})
    for (const SolverStep& step : solver.steps)
      if (step.block == block) add(step);
  add({&torn_mesh, Block::frame_end});
  for (const SolverStep& step : kEveryFrame) add(step);
  return steps;
}

void require_precision(const Model& model, const Solver& solver, std::string_view precision) {
  if (precision != "f32" && precision != "f32k" && precision != "f64")
    throw error(Exit::usage, "{}: solver.precision is \"{}\"; it must be one of: f32, f32k, f64",
                place_of(model.scene, "solver.precision"), precision);
  if (precision != "f32k" || has_compensated(solver)) return;
  std::string able;
  for (const Solver* other : solvers())
    if (has_compensated(*other)) able += (able.empty() ? "" : ", ") + std::string(other->name);
  throw error(Exit::usage,
              "{}: solver.precision is f32k, and {} has no compensated form; use f32 or f64, or one of the "
              "solvers {}",
              place_of(model.scene, "solver.precision"), solver.name, able);
}

/// Of capsules, boxes and a tilted floor, the first that the scene has.
std::string solid_key(const Model& model) {
  const Scene& scene = model.scene;
  return !scene.capsules.empty() ? "capsules.0" : !scene.boxes.empty() ? "boxes.0" : "floor.normal";
}

/// What a scene may call for and only some solvers have the passes of: listed by one of these passes.
struct Need {
  bool (*called_for)(const Model&);
  const Pass* pass;
  std::string (*key)(const Model&);    ///< or section, that calls for it
  std::string (*about)(const Model&);  ///< key and value
  std::string_view cure;
};
const Need kNeeds[] = {
    {[](const Model& m) { return m.scene.self_collision.has_value(); }, &self_contact,
     [](const Model&) { return std::string("self_collision"); },
     [](const Model& m) {
       return fmt::format("[self_collision] with thickness {} m", m.scene.self_collision->thickness_m);
     },
     "remove the section to simulate the cloth without it"},
    {has_strain_limit, &strain_limit, [](const Model&) { return std::string("material.strain_limit"); },
     [](const Model& m) { return fmt::format("material.strain_limit is {}", m.scene.material.strain_limit); },
     "set it to 0"},
    {[](const Model& m) { return !solid_contact.domain(m).empty(); }, &solid_contact, solid_key,
     [](const Model&) { return std::string("[[capsules]], [[boxes]] or a tilted [floor]"); }, "remove them"},
    {[](const Model& m) { return !m.meshes.empty(); }, &mesh_contact,
     [](const Model&) { return std::string("meshes.0"); },
     [](const Model&) { return std::string("[[meshes]]"); }, "remove them"},
    {[](const Model& m) { return m.scene.aerodynamics.has_value(); }, &aerodynamics,
     [](const Model&) { return std::string("aerodynamics"); },
     [](const Model&) { return std::string("[aerodynamics]"); }, "use [air]"},
    {[](const Model& m) { return m.scene.tethers.has_value(); }, &xpbd_tethers,
     [](const Model&) { return std::string("tethers"); },
     [](const Model& m) { return fmt::format("[tethers] with slack {}", m.scene.tethers->slack); },
     "remove the section"},
    {[](const Model& m) { return m.scene.tearing.has_value(); }, &tear,
     [](const Model&) { return std::string("tearing"); },
     [](const Model& m) { return fmt::format("[tearing] with strain {}", m.scene.tearing->strain); },
     "remove the section"},
};

bool lists(const Solver& solver, const Pass* pass) {
  return std::ranges::any_of(solver.steps, [pass](const SolverStep& step) { return step.pass == pass; });
}

const Need* unmet_need(const Model& model, const Solver& solver) {
  const auto* need = std::ranges::find_if(
      kNeeds, [&](const Need& n) { return n.called_for(model) && !lists(solver, n.pass); });
  return need == std::end(kNeeds) ? nullptr : need;
}

void require_passes(const Model& model, const Solver& solver) {
  const Need* need = unmet_need(model, solver);
  if (need == nullptr) return;
  std::string able;
  for (const Solver* other : solvers())
    if (lists(*other, need->pass)) able += (able.empty() ? "" : ", ") + std::string(other->name);
  throw error(Exit::usage, "{}: {}: the solver {} has no passes for it; use one of {}, or {}",
              place_of(model.scene, need->key(model)), need->about(model), solver.name, able, need->cure);
}

/// A link that is too long is either pulled back or breaks.
void require_one_limit(const Model& model) {
  if (model.scene.tearing && has_strain_limit(model))
    throw error(
        Exit::usage,
        "{}: [tearing] stands beside material.strain_limit, which is {}; it must be one or the other, since "
        "a link is either pulled back or breaks (remove one)",
        place_of(model.scene, "tearing"), model.scene.material.strain_limit);
}

/// The section that joins particles by tables for one cloth, where the scene has several; empty: none.
std::string for_one_cloth(const Model& model) {
  if (model.grid.cloths == 1) return "";
  return model.scene.tearing ? "tearing" : model.scene.tethers ? "tethers" : "";
}

void require_one_cloth(const Model& model) {
  const std::string section = for_one_cloth(model);
  if (section.empty()) return;
  throw error(
      Exit::usage,
      "{}: [{}] stands beside [[cloths]], of which there are {}; it must be one or the other, since it is "
      "for one cloth (remove one)",
      place_of(model.scene, section), section, model.scene.cloths.size());
}

}  // namespace

bool has_compensated(const Solver& solver) {
  // Of what it repeats: verlet's closing kick is leapfrog's, and its substeps sum plainly.
  return std::ranges::any_of(solver.steps, [](const SolverStep& s) {
    return s.block == Block::substep && s.pass->compensated != nullptr;
  });
}

std::string what_solver_lacks(const Model& model, const Solver& solver) {
  const Need* need = unmet_need(model, solver);
  if (need != nullptr) return "has no passes for " + need->about(model);
  const std::string section = for_one_cloth(model);
  return section.empty() ? "" : "takes [" + section + "] for one cloth only";
}

Plan compile_plan(const Model& model, const Solver& solver, std::string_view precision) {
  require_precision(model, solver, precision);
  require_passes(model, solver);
  require_one_limit(model);
  require_one_cloth(model);
  Plan plan{};
  plan.solver = &solver;
  plan.precision = precision;
  plan.substeps = substeps_per_frame(model, solver);
  plan.steps = steps_for(model, solver, plan.substeps, precision == "f32k");
  if (plan.in_double())  // drawing reads floats
    plan.steps.push_back({.pass = &present,
                          .block = Block::frame_end,
                          .repeat = 1,
                          .range = present.domain(model),
                          .constants = {}});
  plan.reaching.links = asks_links(model) && std::ranges::any_of(plan.steps, [](const PlanStep& step) {
                          return step.pass->sees_links;
                        });
  plan.reaching.bodies = asks_bodies(model);
  plan.reaching.tears = model.scene.tearing.has_value();
  plan.spreads = has_spread_frames(plan, model);
  plan.buffers = buffers_for(model, plan);
  plan.left_out = left_out_effects(model);
  if (model.grid.cloths > 1) plan.sheet_rows = model.grid.ny;
  return plan;
}

std::uint64_t Plan::bytes() const {
  std::uint64_t sum = 0;
  for (const PlanBuffer& buffer : buffers) sum += buffer.bytes;
  return sum;
}

std::optional<std::uint32_t> Reaching::word(const PlanStep& step) const {
  if (step.pass->reach_word == nullptr) return std::nullopt;
  const bool by_links = step.pass == &strain_limit || step.pass == &tear;
  const bool by_bodies = step.pass == &solid_contact || step.pass == &mesh_contact;
  if ((by_links && !links) || (by_bodies && !bodies)) return std::nullopt;
  return step.pass->reach_word(step.item);
}

std::uint64_t Plan::dispatches() const {
  std::uint64_t sum = 0;
  for (const PlanStep& step : steps) sum += step.repeat;
  return sum;
}

}  // namespace weft
