// Steps down come quickly, steps up are tried now and then: what a picture costs the simulation is only known
// by trying, for both share caches and memory as well as cores.
#include "viewer/picture_share.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace weft {
namespace {

struct Step {
  double pictures_per_s, scale_most;
  std::uint32_t cells_most;
  double wall_share;  ///< of the main loop, for pictures: what they take beyond it makes them fewer
};
constexpr std::array kSteps{Step{1e9, 1.0, 1u << 31, 1.0}, Step{30.0, 0.8, 192, 0.6},
                            Step{20.0, 0.65, 128, 0.45}, Step{15.0, 0.5, 64, 0.3}};
constexpr double kLongestTurn_s = 0.25;  // a pause is no slow motion

}  // namespace

void PictureShare::look(double wall_s, bool may, bool slow) {
  if (!may) {
    *this = {};
    return;
  }
  wall_s = std::min(wall_s, kLongestTurn_s);
  since_s_ += wall_s;
  slow_s_ = slow ? slow_s_ + wall_s : 0.0;
  if (slow_s_ >= kPatience_s && step_ + 1 < kSteps.size()) {
    rest_s_ = tried_ ? std::min(2.0 * rest_s_, kRestMost_s) : rest_s_;
    ++step_;
    since_s_ = slow_s_ = 0.0;
    tried_ = false;
  } else if (!slow && step_ > 0 && since_s_ >= rest_s_) {
    --step_;
    since_s_ = 0.0;
    tried_ = true;
  } else if (tried_ && since_s_ >= kRest_s) {
    rest_s_ = kRest_s;
    tried_ = false;
  }
}

double PictureShare::period_s(double display_s, double paint_s, double part_s) const {
  const double fitting_s = std::min(paint_s / kSteps[step_].wall_share, kLongestPeriod_s - part_s);
  return std::max({display_s, 1.0 / kSteps[step_].pictures_per_s, step_ > 0 ? fitting_s : 0.0});
}

double PictureShare::scale_most() const { return kSteps[step_].scale_most; }

std::uint32_t PictureShare::cells_most() const { return kSteps[step_].cells_most; }

std::string PictureShare::text(double display_s, double paint_s, double scale) const {
  if (step_ == 0) return "";
  const std::string size = scale < 0.999 ? fmt::format(" at {:.0f} % of the size", 100.0 * scale) : "";
  return fmt::format("{:.0f} pictures/s{}, so that the simulation keeps up",
                     std::floor(1.0 / period_s(display_s, paint_s) + 0.5), size);
}

}  // namespace weft
