// The debug switch that falsifies one constant of one pass on the device, so that a check can be seen to
// fail.
#pragma once
#include <glm/vec4.hpp>
#include <span>
#include <string>

#include "plan/plan.h"
#include "shared/params.h"

namespace weft {

/// One constant of one pass, off by one part in a hundred (lengths by a hundredth of the cloth's spacing);
/// `pins` is switched off.
class Perturbation {
 public:
  Perturbation() = default;
  /// @param name  "pass.constant"; empty: nothing is falsified
  /// @throws Error(Exit::usage) when the plan has no such constant on; lists those it has.
  Perturbation(const std::string& name, const Plan& plan);
  void apply(Plan& plan) const;
  void apply(const Model& model, shared::Params& params) const;
  /// @param rows  one substep table, `stride` vec4s a row
  void apply(std::span<glm::vec4> rows, std::uint32_t stride) const;
  const std::string& name() const { return name_; }

 private:
  std::string name_, pass_, constant_;
};

}  // namespace weft
