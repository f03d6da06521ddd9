// How much drawing a software device may do on the cores that also compute: fewer and smaller pictures while
// the simulation does not keep real time, and back again when there is room. The simulation never sees it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

namespace weft {

class PictureShare {
 public:
  /// One look a turn of the main loop.
  /// @param wall_s  since the look before
  /// @param may     whether drawing takes the simulation's cores, which runs; else all is restored
  /// @param slow    less than the wanted speed was reached in the last second or so
  void look(double wall_s, bool may, bool slow);

  /// Steps down from full pictures: 0 is none.
  std::size_t step() const { return step_; }
  /// Wall time from one picture to the next [s].
  /// @param display_s  what the display would have
  /// @param paint_s    what the main loop spends on a picture
  /// @param part_s     what a picture that is due may still have to wait for
  double period_s(double display_s, double paint_s, double part_s = 0.0) const;
  /// The largest share of the window's pixels, along each side, that the scene may be drawn with.
  double scale_most() const;
  /// How many of the cloth's cells may be drawn along each side: corners are the cores' work too.
  std::uint32_t cells_most() const;
  /// "15 pictures/s at 50 % of the size, so that the simulation keeps up"; empty for full pictures.
  /// @param scale  that pictures are drawn with
  std::string text(double display_s, double paint_s, double scale) const;

  static constexpr double kLongestPeriod_s = 0.13;  ///< however long a picture takes
  static constexpr double kPatience_s = 1.5;        ///< of slow motion before a step down
  static constexpr double kRest_s = 6.0;  ///< without it before a step up is tried; doubled when it failed

 private:
  static constexpr double kRestMost_s = 200.0;
  std::size_t step_ = 0;
  double since_s_ = 0.0, slow_s_ = 0.0, rest_s_ = kRest_s;
  bool tried_ = false;  ///< the latest step was one up, and has not proved itself yet
};

}  // namespace weft
