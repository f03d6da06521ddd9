// XPBD's substeps on the vector units: colour after colour over bands of rows.
#pragma once
#include <atomic>
#include <span>
#include <vector>

#include "native/body_touch.h"
#include "native/cloth.h"
#include "native/crew.h"
#include "plan/plan.h"
#include "shared/params.h"

namespace weft::native {

/// The rows are shared out to threads as in Bands. A colour whose springs reach into the rows below is pulled
/// in two turns: those within each band, then those that reach into the next one; before a turn a band waits
/// for its two neighbours to have ended the one before. Springs of a colour share no particle, so that no bit
/// depends on the division.
class Xpbd {
 public:
  /// @param bodies  what the end of a substep touches; null: none
  Xpbd(Cloth& cloth, const Kernels& kernels, const Model& model, const Plan& plan,
       const BodyTouch* bodies = nullptr);

  /// One substep a kick, in that many of the crew's threads.
  void sweep(Crew& crew, std::uint32_t threads, std::span<const Kick> kicks);
  /// Who is fixed has changed.
  void take_masses();
  std::uint64_t bytes() const {
    return moved_bytes_ + (tether_reach_.size() + several_.size()) * sizeof(float) +
           anchors_.size() * sizeof(std::uint32_t);
  }

 private:
  /// One colour.
  struct Colour {
    void (*pull)(const XpbdPull&);
    XpbdPull what;
    std::size_t reach;  ///< rows down, 0 for springs within a row
  };
  struct alignas(64) Turns {
    std::atomic<std::uint32_t> done{0};
  };
  Colour colour_of(const PlanStep& step, const Model& model) const;
  /// One thread's rows of all cloths, and of each cloth what it has.
  struct Band {
    std::size_t first, last;
    bool goes_on_above, goes_on_below;  ///< its outer cloths, in the neighbours
    std::uint32_t own, count, turn;     ///< which of how many; turns ended
    std::vector<XpbdMove> parts;
  };
  Band band_of(std::uint32_t own, std::uint32_t count);
  void sweep_band(Band band, std::span<const Kick> kicks);
  void pull(const Colour& colour, const Kick& kick, Band& band);
  void end_turn(Band& band);
  void move_pins(const Band& band, const Kick& kick);
  void make_tether_rows();
  std::uint32_t place_among(std::uint32_t anchor) const;
  std::vector<float> anchor_places();
  void end_substep(const XpbdMove& part) const;
  void pull_tethers(std::size_t first_row, std::size_t last_row, const std::vector<float>& places);
  void find_still_anchors();
  void pull_tether(std::size_t particle, const float* anchor);

  Cloth& cloth_;
  const Kernels& kernels_;
  XpbdMove move_{};
  std::vector<Colour> colours_;
  std::vector<MovedParticle> placed_;             ///< where the plan has xpbd_pins
  std::vector<shared::TetherOf<float>> tethers_;  ///< where it has xpbd_tethers
  XpbdTethers all_tethers_{};
  std::vector<float> tether_reach_;  ///< as XpbdTethers has them
  std::vector<std::uint32_t> anchors_;
  std::vector<std::uint32_t> anchor_particles_;  ///< ascending
  std::vector<float> still_places_, several_;    ///< XpbdTethers' of anchors that no pin moves
  std::size_t moved_bytes_;
  Floats moved_;
  const BodyTouch* bodies_;
  std::vector<std::vector<Drifted>> drifted_;  ///< by thread: Bodies' list
  float interior_;                             ///< inverse mass of an interior particle [1/kg]
  bool anchors_move_;
  std::vector<Turns> turns_;
};

}  // namespace weft::native
