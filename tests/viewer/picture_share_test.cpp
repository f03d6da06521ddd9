// A software device draws fewer and smaller pictures while the simulation does not keep real time, restores
// them when there is room, and never changes what is simulated.
#include "viewer/picture_share.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "viewer/pacing.h"

namespace weft {
namespace {

constexpr double kDisplay_s = 1.0 / 60.0;

/// A machine on which a picture takes the cores for so long (at full size), and a frame for so long.
struct Machine {
  double picture_s, frame_s;
};

struct Watched {
  std::size_t frames = 0, pictures = 0;
  double real_time_factor = 0.0;
};

/// So many seconds of wall time: each turn pays the frames that are owed, within 40 ms, and its picture.
Watched watched_for(const Machine& machine, double wall_s, Pacer& pacer, PictureShare& share) {
  Watched done;
  double now_s = 0.0, picture_s = -1.0, turn_s = kDisplay_s;
  while (now_s < wall_s) {
    pacer.elapse(turn_s);
    double busy_s = 0.0;
    while (pacer.frame_due() && busy_s < 0.04) {
      busy_s += machine.frame_s;
      pacer.frame_done();
      ++done.frames;
    }
    pacer.give_up_rest();
    share.look(turn_s, true, pacer.slow_motion());
    if (now_s - picture_s >= share.period_s(kDisplay_s, 0.0) - 0.5 * kDisplay_s) {
      busy_s += machine.picture_s * share.scale_most() * share.scale_most();
      picture_s = now_s;
      ++done.pictures;
    }
    turn_s = std::max(busy_s, kDisplay_s);
    now_s += turn_s;
  }
  done.real_time_factor = pacer.real_time_factor();
  return done;
}

TEST(PictureShare, KeepsFullPicturesWhereTheSimulationKeepsUp) {
  Pacer pacer(kDisplay_s);
  PictureShare share;
  const Watched fast = watched_for({.picture_s = 0.008, .frame_s = 0.004}, 20.0, pacer, share);
  EXPECT_EQ(share.step(), 0u);
  EXPECT_NEAR(static_cast<double>(fast.pictures), 1200.0, 12.0);
  EXPECT_EQ(share.text(kDisplay_s, 0.01, 1.0), "");
}

/// 12 ms a frame are 0.72 s a second; four of them and a picture of 50 ms take 98 ms, in which six are owed.
/// 15 pictures of a quarter of the pixels take 0.19 s more, which fits.
TEST(PictureShare, DrawsLessUntilTheSimulationKeepsRealTime) {
  const Machine machine{.picture_s = 0.050, .frame_s = 0.012};
  Pacer pacer(kDisplay_s);
  PictureShare share;
  const Watched before = watched_for(machine, PictureShare::kPatience_s, pacer, share);
  EXPECT_LT(before.real_time_factor, 0.8);
  const Watched later = watched_for(machine, 40.0, pacer, share);
  EXPECT_GE(share.step(), 1u);
  EXPECT_GE(static_cast<double>(later.frames), 0.93 * 40.0 * 60.0);
  EXPECT_NE(share.text(kDisplay_s, 0.01, share.scale_most()).find("so that the simulation keeps up"),
            std::string::npos);
}

TEST(PictureShare, RestoresThePicturesWhenThereIsRoom) {
  Pacer pacer(kDisplay_s);
  PictureShare share;
  watched_for({.picture_s = 0.020, .frame_s = 0.016}, 10.0, pacer, share);
  ASSERT_GE(share.step(), 2u);
  watched_for({.picture_s = 0.004, .frame_s = 0.001}, 60.0, pacer, share);
  EXPECT_EQ(share.step(), 0u);
}

/// What no number of pictures cures is not tried for ever: the rests between two tries double.
TEST(PictureShare, TriesSeldomWhatFails) {
  const Machine machine{.picture_s = 0.020, .frame_s = 0.0125};
  Pacer pacer(kDisplay_s);
  PictureShare share;
  watched_for(machine, 300.0, pacer, share);
  const Watched last = watched_for(machine, 100.0, pacer, share);
  EXPECT_GE(static_cast<double>(last.frames), 0.95 * 100.0 * 60.0);
}

TEST(PictureShare, EndsAtFifteenPicturesOfHalfTheSizeOrWhatFitsInThreeTenthsOfTheTime) {
  PictureShare share;
  for (int turn = 0; turn < 6000; ++turn) share.look(kDisplay_s, true, true);
  EXPECT_NEAR(share.period_s(kDisplay_s, 0.01), 1.0 / 15.0, 1e-12);
  EXPECT_NEAR(share.period_s(kDisplay_s, 0.03), 0.1, 1e-12) << "three tenths of the time, at most";
  EXPECT_NEAR(share.period_s(kDisplay_s, 10.0), 0.13, 1e-12) << "the window stays a window";
  EXPECT_NEAR(share.period_s(kDisplay_s, 10.0, 0.04), 0.09, 1e-12) << "a part of a frame comes on top";
  EXPECT_EQ(share.scale_most(), 0.5);
  EXPECT_EQ(share.text(kDisplay_s, 0.01, 0.5),
            "15 pictures/s at 50 % of the size, so that the simulation keeps up");
  share.look(kDisplay_s, false, true);  // paused: nothing competes with the pictures
  EXPECT_EQ(share.step(), 0u);
}

}  // namespace
}  // namespace weft
