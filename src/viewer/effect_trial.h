// What an effect costs that is folded into a pass with others: frames with and without it, in turn, on
// copies of the running cloth.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/drawn_simulation.h"

namespace weft {

/// What a trial found of one effect [ms a frame].
struct EffectCost {
  double ms = 0.0;        ///< with it less without it; not below zero
  double doubt_ms = 0.0;  ///< less than this is not told from nothing
};

/// The scene's effects whose cost can be told by leaving them out: all but the pins, without which it would
/// be another motion.
std::vector<std::string> removable_effects(const Scene& scene);

class EffectTrial {
 public:
  /// Reads the state; makes no copy yet.
  /// @param running   the cloth; its substeps a frame are kept, whatever is left out
  /// @param make_copy  a simulation of another model where the running one is computed
  using CopyMaker = std::function<std::unique_ptr<DrawnSimulation>(const Model&)>;
  EffectTrial(DrawnSimulation& running, CopyMaker make_copy);
  EffectTrial(const EffectTrial&) = delete;
  EffectTrial& operator=(const EffectTrial&) = delete;

  /// The next part, at most about 50 ms on the device (a new copy may have to compile its pipelines). Returns
  /// whether more is left.
  bool go_on();
  std::size_t done() const { return next_; }
  std::size_t total() const { return effects_.size(); }
  const std::map<std::string, EffectCost, std::less<>>& costs() const { return costs_; }

 private:
  struct Copy {
    std::unique_ptr<DrawnSimulation> simulation;
    std::vector<double> frames_ms;
    bool under_way = false;
  };
  Copy copy_of(const Scene& scene) const;
  bool frame_part(Copy& copy);
  void settle();

  CopyMaker make_copy_;
  Scene scene_;
  State state_;
  std::vector<std::string> effects_;
  std::size_t next_ = 0;
  std::optional<Copy> with_, without_;
  std::map<std::string, EffectCost, std::less<>> costs_;
};

}  // namespace weft
