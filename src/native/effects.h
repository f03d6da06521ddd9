// The passes beside the sweep that run on the cloth's rows: pins that move or let go, links that break.
#pragma once
#include <span>
#include <vector>

#include "native/cloth.h"
#include "native/crew.h"
#include "passes/ground.h"
#include "plan/plan.h"

namespace weft::native {

class Effects {
 public:
  /// @param touches_bodies  whether contact with bodies is a pass here
  Effects(Cloth& cloth, const Kernels& kernels, const Model& model, bool touches_bodies);

  /// Whether the pass runs here.
  static bool has(const Pass& pass);
  /// Keeps where the particles are, if contact will ask where a drift began.
  void begin_drift(Crew& crew, std::uint32_t threads);
  /// One dispatch of such a pass, in that many of the crew's threads. Returns whether it changed who is
  /// fixed.
  bool run(const PlanStep& step, const Kick& kick, Crew& crew, std::uint32_t threads);
  std::uint64_t bytes() const;

 private:
  bool release_pins(const Kick& kick);
  void place_pins(const Kick& kick);
  void kick_by_air(const Kick& kick, Crew& crew, std::uint32_t threads);
  /// act(ClothRows) with the rows of each cloth, shared out to so many of the crew's threads.
  template <class Act>
  void share_out(Crew& crew, std::uint32_t threads, const Act& act);
  void touch_solids(const Kick& kick, Crew& crew, std::uint32_t threads);
  void touch_by_mirror(std::uint32_t particle, const Kick& kick);
  void tear_links(Crew& crew, std::uint32_t threads);

  Cloth& cloth_;
  const Kernels& kernels_;
  std::vector<float*> rows_;  ///< as Cloth::padded_rows
  Floats before_;             ///< positions where the drift began, where contact with solids asks for them
  std::uint32_t solid_count_;
  bool knows_near_;  ///< whether rows of the schedule say which drifts may touch solids
  Ground<float> ground_;
  std::vector<std::uint32_t> left_over_;
  Floats kicked_;  ///< velocities after the air's kick, where the scene has [aerodynamics]
  std::vector<MovedParticle> held_;
  std::vector<float> loosest_;  ///< relative inverse mass of each once it is let go
  float longest_structural_m2_ = 0, longest_shear_m2_ = 0;
  std::vector<std::uint32_t> links_before_;
};

}  // namespace weft::native
