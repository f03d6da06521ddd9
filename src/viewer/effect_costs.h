// The milliseconds beside switches and sliders: what passes of an effect's own take this frame, and for what
// is folded into a pass with others what a trial found.
#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "viewer/effect_trial.h"
#include "viewer/running_scene.h"

namespace weft {

/// Names of the passes that are in the scene's plan because of this effect alone; empty when it is folded
/// into a pass that runs anyway.
std::vector<std::string> passes_of_effect(const Scene& scene, std::string_view effect);

class EffectCosts {
 public:
  explicit EffectCosts(gpu::Device& device) : device_(device) {}

  /// Once a picture. What a trial found is forgotten when another plan runs.
  void follow(RunningScene& running);
  void start_trial(RunningScene& running);
  void cancel_trial() { trial_.reset(); }
  const EffectTrial* trial() const { return trial_.get(); }

  /// "3.21 ms" this frame, "0.40 ms (trial)", "< 0.1 ms (trial)"; empty when it is not known.
  /// @param effect  a section of the scene, "bend", or "normals"
  std::string text(std::string_view effect) const;

 private:
  void sort_passes(const Scene& scene);

  gpu::Device& device_;
  std::vector<std::string> kinds_;  // effects and solver that own_passes_ is of
  std::uint64_t shown_version_ = 0, version_ = 0;
  std::map<std::string, std::vector<std::string>, std::less<>> own_passes_;
  std::map<std::string, double, std::less<>> pass_ms_;  // of the running frame, smoothed
  std::map<std::string, EffectCost, std::less<>> found_;
  std::unique_ptr<EffectTrial> trial_;
};

}  // namespace weft
