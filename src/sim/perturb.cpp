// The debug switch that falsifies one constant of one pass on the device.
#include "sim/perturb.h"

#include "core/error.h"

namespace weft {
namespace {

constexpr float kFactor = 1.01f;

std::string choices(const Plan& plan) {
  std::string text;
  for (const PlanStep& step : plan.steps)
    for (const Constant& constant : step.constants) {
      const std::string name = fmt::format("{}.{}", step.pass->name, constant.name);
      if (constant.value != 0 && text.find(name) == std::string::npos)
        text += (text.empty() ? "" : ", ") + name;
    }
  return text.empty() ? "none" : text;
}

}  // namespace

Perturbation::Perturbation(const std::string& name, const Plan& plan) {
  if (name.empty()) return;
  for (const PlanStep& step : plan.steps)
    for (const Constant& constant : step.constants)
      if (name == fmt::format("{}.{}", step.pass->name, constant.name)) {
        if (constant.value == 0) return;
        pass_ = step.pass->name;
        constant_ = constant.name;
        return;
      }
  throw error(Exit::usage,
              "perturb is \"{}\"; it must be PASS.CONSTANT of an effect in this scene's plan: {}", name,
              choices(plan));
}

void Perturbation::apply(Plan& plan) const {
  if (constant_ != "pins") return;
  for (PlanStep& step : plan.steps)
    for (Constant& constant : step.constants)
      if (step.pass->name == pass_ && constant.name == "pins") constant.value = 0;
}

void Perturbation::apply(const Model& model, shared::Params& params) const {
  const float length_m = static_cast<float>(0.01 * model.grid.spacing_m);
  if (constant_ == "shear") params.shear.x *= kFactor;
  if (constant_ == "flex")
    for (glm::vec4& row : params.flex) row.x *= kFactor;
  if (constant_ == "bending")  // rows of pairs that triples lean on
    for (std::size_t row = 0; row < 12; ++row)
      if (row % 3 != 0) params.structural[row].x *= kFactor;
  if (constant_ == "damping") {
    for (glm::vec4& row : params.structural) row.z *= kFactor;
    for (glm::vec4& row : params.flex) row.z *= kFactor;
    params.shear.z *= kFactor;
  }
  if (constant_ == "gravity") params.gravity_m_s2 *= kFactor;
  if (constant_ == "floor") params.floor_height_m += length_m;
}

void Perturbation::apply(ConstraintRows<float>& constraints) const {
  if (constant_ == "damping")
    for (glm::vec4& row : constraints) row.z *= kFactor;
}

void Perturbation::apply(std::span<glm::vec4> rows, std::uint32_t stride) const {
  for (std::size_t row = 0; row + stride <= rows.size(); row += stride) {
    if (constant_ == "air") rows[row].w *= kFactor;
    if (constant_ == "wind")
      for (int axis = 0; axis < 3; ++axis) rows[row][axis] *= kFactor;
    if (constant_ == "spheres")
      for (std::size_t sphere = shared::kRowHeadVec4s; sphere < stride; sphere += shared::kRowSphereVec4s)
        rows[row + sphere].w *= kFactor;
  }
}

}  // namespace weft
