// The debug switch that falsifies one constant of one pass on the device.
#include "sim/perturb.h"

#include "core/error.h"

namespace weft {
namespace {

template <class T>
constexpr T kFactor = T(1.01);

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

template <class T>
void Perturbation::apply(const Model& model, shared::ParamsOf<T>& params) const {
  const T length_m = static_cast<T>(0.01 * model.grid.spacing_m);
  if (constant_ == "shear") params.shear.x *= kFactor<T>;
  if (constant_ == "flex")
    for (glm::vec<4, T>& row : params.flex) row.x *= kFactor<T>;
  if (constant_ == "bending")  // rows of pairs that triples lean on
    for (std::size_t row = 0; row < 12; ++row)
      if (row % 3 != 0) params.structural[row].x *= kFactor<T>;
  if (constant_ == "damping") {
    for (glm::vec<4, T>& row : params.structural) row.z *= kFactor<T>;
    for (glm::vec<4, T>& row : params.flex) row.z *= kFactor<T>;
    params.shear.z *= kFactor<T>;
  }
  if (constant_ == "gravity") params.gravity_m_s2 *= kFactor<T>;
  if (constant_ == "floor") params.floor_height_m += length_m;
}

template <class T>
void Perturbation::apply(ConstraintRows<T>& constraints) const {
  if (constant_ == "damping")
    for (glm::vec<4, T>& row : constraints) row.z *= kFactor<T>;
}

template <class T>
void Perturbation::apply(std::span<glm::vec<4, T>> rows, std::uint32_t stride, std::size_t spheres) const {
  for (std::size_t row = 0; row + stride <= rows.size(); row += stride) {
    if (constant_ == "air") rows[row].w *= kFactor<T>;
    if (constant_ == "wind")
      for (int axis = 0; axis < 3; ++axis) rows[row][axis] *= kFactor<T>;
    if (constant_ == "spheres")
      for (std::size_t sphere = 0; sphere < spheres; ++sphere)
        rows[row + shared::kRowHeadVec4s + sphere * shared::kRowSphereVec4s].w *= kFactor<T>;
  }
}

template void Perturbation::apply(const Model&, shared::ParamsOf<float>&) const;
template void Perturbation::apply(const Model&, shared::ParamsOf<double>&) const;
template void Perturbation::apply(ConstraintRows<float>&) const;
template void Perturbation::apply(ConstraintRows<double>&) const;
template void Perturbation::apply(std::span<glm::vec<4, float>>, std::uint32_t, std::size_t) const;
template void Perturbation::apply(std::span<glm::vec<4, double>>, std::uint32_t, std::size_t) const;

}  // namespace weft
