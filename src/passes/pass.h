// A pass: its declaration (name, where it runs, which constants) and its independent
// CPU mirror. Its shader is shaders/passes/<name>.comp; bindings are read from the SPIR-V.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "model/model.h"
#include "passes/host_buffers.h"

namespace weft {

/// Items along x and y that a dispatch covers; empty means "not in the plan".
struct Range {
  std::uint32_t x = 0, y = 0;
  std::uint32_t cloth = 0, offset = 0;  ///< which cloth, and its first item
  bool empty() const { return x == 0 || y == 0; }
  std::uint64_t items() const { return std::uint64_t{x} * y; }
};

/// A specialization constant; its id is its place in the list. bools are 0 or 1.
struct Constant {
  std::string_view name;
  std::uint32_t value;
};
using Constants = std::vector<Constant>;

/// One row of a frame's schedule in double: what dispatch r does. (kick, drift) are data.
struct KickDrift {
  double kick_s = 0, drift_s = 0;
  double kick_time_s = 0;   ///< when the kick's wind is evaluated
  double drift_time_s = 0;  ///< when the drift begins
  double predict_s = 0;     ///< a further kick that only predicts a velocity; 0: none
  bool plain_air = false;   ///< Runge–Kutta: air is an ordinary force; the row has α for its loss
};

/// What a mirror sees: the model, the constants of the step, which dispatch of the frame it is.
struct MirrorContext {
  const Model& model;
  std::span<const Constant> constants;
  const KickDrift& row;
  std::uint32_t row_index = 0;
  std::uint32_t item = 0;          ///< of the plan's step: which part of the pass's work
  double speed_allowed_m_s = 0.0;  ///< at the frame's end, of SpeedBudget; 0: any
};

/// The domain of a pass that has one invocation a particle.
inline Range whole_cloth(const Model& m) { return {.x = m.grid.nx, .y = m.grid.rows()}; }

struct Pass {
  std::string_view name;
  std::string_view about;
  Range (*domain)(const Model&);
  Constants (*constants)(const Model&) = [](const Model&) { return Constants{}; };
  /// Of one dispatch.
  std::uint64_t (*spring_evaluations)(const Model&) = [](const Model&) { return std::uint64_t{0}; };
  void (*mirror_f32)(const MirrorContext&, HostBuffers<float>&);
  void (*mirror_f64)(const MirrorContext&, HostBuffers<double>&);
  bool swaps_state = false;  ///< writes position_next and velocity_next, which then become current
  bool marches = false;  ///< one invocation may take several rows: the constant after its own says how many
  bool takes_texels = false;          ///< its shader reads vectors as texels where the kernel does
  const Pass* compensated = nullptr;  ///< the same with compensated summation of positions (f32k)
  const Pass* torn = nullptr;         ///< what stands in its place where links break
  const Pass* once_torn = nullptr;    ///< what runs before it there, and in its place once a link is broken
  /// For passes that a solver lists once an item (a colour of springs): where that item runs and how many
  /// springs it evaluates. domain and spring_evaluations are not asked then.
  Range (*item_domain)(const Model&, std::uint32_t item) = nullptr;
  std::uint64_t (*item_spring_evaluations)(const Model&, std::uint32_t item) = nullptr;
  /// In the substep block: runs in the first substep of a frame and every so many after it; null: in each.
  std::uint32_t (*interval)(const Model&, double substep_s) = nullptr;
  /// Runs only where this word of collision_state is not 0; the word and the two after it are its workgroups,
  /// by which a device skips it without being asked. The mirror and the shader look at the word themselves.
  std::optional<std::uint32_t> groups_word = std::nullopt;
  /// The same of reach_groups, for an item of the pass, in plans that ask (Plan::reach_word); null: none.
  std::uint32_t (*reach_word)(std::uint32_t item) = nullptr;
  bool tells_reach = false;  ///< moves particles, and says in reach_groups whether one came near a body
  bool sees_links = false;   ///< and whether a link came near its limit
  /// Brings indices whose order the device may choose into one order, for comparisons; null: there are none.
  void (*settle_order)(HostWords&) = nullptr;
};

}  // namespace weft
