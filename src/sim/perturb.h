// The debug switch that falsifies one constant of one pass on the device, so that a check can be seen to
// fail.
#pragma once
#include <glm/vec4.hpp>
#include <span>
#include <string>

#include "passes/xpbd.h"
#include "plan/plan.h"
#include "shared/params.h"

namespace weft {

/// One constant of one pass, off by one part in a hundred (lengths by a hundredth of the cloth's spacing);
/// `pins` is switched off.
class Perturbation {
 public:
  Perturbation() = default;
  /// @param name  "pass.constant"; empty: nothing is falsified. A constant that is off in this plan has
  /// nothing to
  ///              falsify: active() is then false.
  /// @throws Error(Exit::usage) when no pass of the plan has such a constant; lists those that are on.
  Perturbation(const std::string& name, const Plan& plan);
  bool active() const { return !constant_.empty(); }
  void apply(Plan& plan) const;
  template <class T>
  void apply(const Model& model, shared::ParamsOf<T>& params) const;
  template <class T>
  void apply(ConstraintRows<T>& constraints) const;
  /// @param rows  one substep table
  template <class T>
  void apply(const Model& model, std::span<glm::vec<4, T>> rows) const;

 private:
  std::string pass_, constant_;
};

}  // namespace weft
