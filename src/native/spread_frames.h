// Frames that are swept without self-collision's passes, for the cloth stays spread out: looks at the cloth,
// in all threads, and what has to be put back if it does not.
#pragma once
#include <cstdint>
#include <vector>

#include "native/cloth.h"
#include "native/crew.h"
#include "passes/host_buffers.h"
#include "plan/spread_watch.h"

namespace weft::native {

class SpreadFrames {
 public:
  /// @param plan, model  as has_spread_frames allows; the cloth outlives this
  SpreadFrames(Cloth& cloth, const Kernels& kernels, const Plan& plan, const Model& model);

  /// Whether the frame that begins may be swept so. Then the words of collision_state are as after lists that
  /// are empty, and say that there are none for later frames.
  bool begin_frame(HostBuffers<float>& buffers, Crew& crew, std::uint32_t threads);
  /// How many of so many substeps to sweep before the next look; 0: the frame has to be taken back.
  std::uint32_t substeps(double drift_s, std::uint32_t most) const;
  /// After them: whether the cloth was spread all the way.
  bool stayed_spread(double drift_s, std::uint32_t substeps, float kick2, Crew& crew, std::uint32_t threads);
  /// Words of the buffers to what they were when the frame began; rows are somebody else's.
  void take_back_frame(HostBuffers<float>& buffers);

  /// Whether the cloth is spread by a margin; then `found` says by what, and how it moves.
  bool is_spread_by(double margin, SpreadState& found, Crew& crew, std::uint32_t threads) const;

 private:
  SpreadState look(std::size_t& margin, Crew& crew, std::uint32_t threads) const;

  Cloth& cloth_;
  const Kernels& kernels_;
  SpreadWatch watch_;
  double spacing_m_;
  bool shares_motion_;
  std::vector<const float*> rows_;  ///< of the cloth
  SpreadState now_;
  std::size_t margin_ = 0;       ///< of SpreadBound::kMargins, at the latest look
  bool under_way_ = false;       ///< a frame has been begun, and not taken back
  std::uint32_t held_back_ = 0;  ///< times, when the latest frame began
  std::vector<std::uint32_t> kept_words_;
};

}  // namespace weft::native
