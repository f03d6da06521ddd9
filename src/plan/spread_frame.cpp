// The steps of a frame that needs none of self-collision's passes.
#include "plan/spread_frame.h"

#include <algorithm>

#include "passes/passes.h"
#include "plan/spread_bound.h"

namespace weft {

bool has_spread_frames(const Plan& plan, const Model& model) {
  const Grid& grid = model.grid;
  if (!model.scene.self_collision || grid.cloths != 1 || grid.nx < 2 || grid.ny < 2) return false;
  const bool moved_otherwise = std::ranges::any_of(plan.steps, [](const PlanStep& step) {
    return step.block != Block::frame_end && step.pass != &integrate && !serves_self_collision(*step.pass);
  });
  return plan.precision == "f32" && !moved_otherwise && SpreadBound(plan, model).is_possible();
}

Plan spread_frame(const Plan& plan, const Model& model, std::uint32_t interval) {
  Plan frame = plan;
  frame.spreads = false;
  frame.tells_kicks = true;
  frame.steps.clear();
  PlanStep look{.pass = &spread_look,
                .block = Block::substep,
                .repeat = (plan.substeps - 1) / interval + 1,
                .range = spread_look.domain(model),
                .constants = {},
                .interval = interval};
  for (const PlanStep& step : plan.steps) {
    if (serves_self_collision(*step.pass)) continue;
    const bool moves = step.pass == &integrate;
    if (moves && step.block == Block::substep) frame.steps.push_back(look);
    frame.steps.push_back(step);
    if (!moves || step.block != Block::frame_end) continue;
    look.block = Block::frame_end;
    look.repeat = look.interval = 1;
    frame.steps.push_back(look);
  }
  return frame;
}

}  // namespace weft
