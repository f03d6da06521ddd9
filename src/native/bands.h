// The cloth's rows shared out to threads: each sweeps a band of its own and waits for its two neighbours
// alone.
#pragma once
#include <atomic>
#include <memory>
#include <span>
#include <vector>

#include "native/body_touch.h"
#include "native/cloth.h"
#include "native/crew.h"
#include "native/leap_watch.h"
#include "native/thread_speeds.h"

namespace weft::native {

/// How the rows are divided, and what bands hand each other. A band hands on its outer two rows of each end
/// after every sweep, into one of two copies by turns: a neighbour reads one while the other is written, so
/// that nobody waits for a reader. What is below it a band asks for only when it gets there, so that each may
/// lag behind the one above and what that one hands on is there in time. Where one cloth ends and another
/// begins nothing is handed on and nobody waits; a band with rows of several cloths sweeps one after the
/// other. No bit depends on the division, which follows the threads' speeds.
class Bands {
 public:
  /// @param count  at most cloth.rows() / kRowsPerBandMin, at least 1
  /// @param half_velocity  velocity Verlet's, 3·stride a row; null in leapfrog
  /// @param bodies  what the sweep touches; null: none
  Bands(Cloth& cloth, const Kernels& kernels, ThreadSpeeds& speeds, std::uint32_t count,
        float* half_velocity = nullptr, const BodyTouch* bodies = nullptr);

  std::uint32_t count() const { return static_cast<std::uint32_t>(bands_.size()); }
  /// One sweep after the other, band by band in the crew's threads.
  /// @param watch  whom they tell of long ways; null: nobody
  /// @param kick2  raised to the largest square of a kick (KicksAsked); null: nobody asks
  void sweep(Crew& crew, std::span<const Kick> kicks, LeapWatch* watch = nullptr, float* kick2 = nullptr);
  /// What is drawn, band by band. `wanted` names the outputs; its rows are set here.
  void surface(Crew& crew, const Surface& wanted);

 private:
  struct alignas(64) Band {
    std::vector<ClothRows> parts;                       ///< by cloth
    std::vector<float*> rows;                           ///< as Cloth::padded_rows
    std::size_t first = 0, last = 0;                    ///< places in these
    bool goes_on_above = false, goes_on_below = false;  ///< its outer cloths, in the neighbours
    Floats carried;
    Floats put_off;                      ///< Sweep's, where there is contact
    std::vector<Drifted> drifted;        ///< likewise with bodies
    Floats handed;                       ///< two copies of four rows
    std::uint32_t leapt = 0;             ///< LeapAsked's, in the present sweeps
    alignas(64) float kicks[kColumns];   ///< KicksAsked's
    std::atomic<std::uint32_t> done{0};  ///< states handed on since the sweeps began
    ThreadWork work;                     ///< since speeds were learnt
  };
  void divide();
  void learn();
  void sweep_band(std::uint32_t own, std::span<const Kick> kicks);
  class StopWatch;
  void sweep_once(std::uint32_t own, std::uint32_t substep, const Kick& kick, StopWatch& busy);
  void sweep_rows(Band& band, const ClothRows& rows, bool goes_on, const Kick& kick);
  void take_above(std::uint32_t own, std::uint32_t substep);
  void take_below(std::uint32_t own, std::uint32_t substep);
  void fetch(const float* rows) const;
  void claim_handed(const Band& band, std::uint32_t substep) const;
  void hand_on(Band& band, std::uint32_t substep);
  float* handed_row(const Band& band, std::size_t copy, std::size_t row) const;

  Cloth& cloth_;
  const Kernels& kernels_;
  ThreadSpeeds& speeds_;
  std::uint64_t divided_by_;  ///< which version of the speeds
  float* half_velocity_;
  const BodyTouch* bodies_;
  Patience patience_;
  LeapWatch* watch_ = nullptr;  ///< of the present sweeps
  bool asks_kicks_ = false;
  std::vector<std::unique_ptr<Band>> bands_;
};

}  // namespace weft::native
