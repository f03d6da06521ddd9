// The debug switch that falsifies one constant of one pass on the device.
#include "sim/perturb.h"

#include "core/error.h"
#include "passes/coefficients.h"

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
void Perturbation::apply(const Model& model, std::span<glm::vec<4, T>> rows) const {
  const RowLayout at = row_layout(model);
  const std::size_t spheres = model.scene.spheres.size();
  const T length_m = static_cast<T>(0.01 * model.grid.spacing_m);
  for (std::size_t row = 0; row + at.stride <= rows.size(); row += at.stride) {
    if (constant_ == "air") rows[row].w *= kFactor<T>;
    if (constant_ == "wind")
      for (int axis = 0; axis < 3; ++axis) rows[row][axis] *= kFactor<T>;
    if (constant_ == "spheres")
      for (std::size_t sphere = 0; sphere < spheres; ++sphere)
        rows[row + shared::kRowHeadVec4s + sphere * shared::kRowSphereVec4s].w *= kFactor<T>;
    for (std::size_t solid = row + at.solids; solid < row + at.meshes; solid += shared::kRowSolidVec4s) {
      if (constant_ == "solids") rows[solid].w += length_m;      // their reach
      if (constant_ == "solid rows") rows[solid].y += length_m;  // their place
    }
    for (std::size_t mesh = row + at.meshes; mesh < row + at.air; mesh += shared::kRowMeshVec4s) {
      if (constant_ == "meshes") rows[mesh].w += length_m;
      if (constant_ == "mesh rows") rows[mesh].y += length_m;
    }
    if (constant_ == "air rows") rows[row + at.air].z += T(0.01);
    if (constant_ == "noise") rows[row + at.air + 2].y *= kFactor<T>;
    if (constant_ == "seed") rows[row + at.air + 2].x += T(1);
    if (constant_ == "tilted floor") rows[row + at.floor].w += length_m;
  }
}

template void Perturbation::apply(const Model&, shared::ParamsOf<float>&) const;
template void Perturbation::apply(const Model&, shared::ParamsOf<double>&) const;
template void Perturbation::apply(ConstraintRows<float>&) const;
template void Perturbation::apply(ConstraintRows<double>&) const;
template void Perturbation::apply(const Model&, std::span<glm::vec<4, float>>) const;
template void Perturbation::apply(const Model&, std::span<glm::vec<4, double>>) const;

}  // namespace weft
