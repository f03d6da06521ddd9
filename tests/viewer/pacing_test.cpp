// The pace of the window: fixed steps from real time, and slow motion that is told.
#include "viewer/pacing.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace weft {
namespace {

/// Lets pictures of `picture_s` go by, computing at most `most` frames in each; returns frames computed.
int run(Pacer& pacer, double picture_s, int pictures, int most) {
  int frames = 0;
  for (int k = 0; k < pictures; ++k) {
    pacer.elapse(picture_s);
    for (int done = 0; done < most && pacer.frame_due(); ++done, ++frames) pacer.frame_done();
    pacer.give_up_rest();
  }
  return frames;
}

TEST(Pacer, FramesFollowRealTimeAtAnyPictureRate) {
  for (const double rate : {30.0, 59.0, 60.0, 61.0, 144.0}) {
    Pacer pacer(1.0 / 60.0);
    const int frames = run(pacer, 1.0 / rate, static_cast<int>(10.0 * rate), 100);
    EXPECT_NEAR(frames, 600, 1) << rate;
    EXPECT_NEAR(pacer.real_time_factor(), 1.0, 0.04) << rate;
    EXPECT_FALSE(pacer.slow_motion()) << rate;
  }
}

TEST(Pacer, SpeedScalesTheFramesNotTheirLength) {
  Pacer pacer(1.0 / 60.0);
  pacer.set_speed(0.25);
  EXPECT_NEAR(run(pacer, 1.0 / 60.0, 600, 100), 150, 1);
  EXPECT_EQ(pacer.frame_s(), 1.0 / 60.0);
  EXPECT_FALSE(pacer.slow_motion()) << "a quarter is what was asked for";
}

// One frame of 1/60 s in each picture of 1/20 s is a third of real time, and nothing is caught up later.
TEST(Pacer, WhatCannotBeComputedIsSlowMotion) {
  Pacer pacer(1.0 / 60.0);
  EXPECT_EQ(run(pacer, 1.0 / 20.0, 60, 1), 60);
  EXPECT_NEAR(pacer.real_time_factor(), 1.0 / 3.0, 0.02);
  EXPECT_TRUE(pacer.slow_motion());
  EXPECT_LE(run(pacer, 1.0 / 60.0, 60, 100), 62) << "at most one frame of debt remains";
}

// A hitch of 50 ms, three frames, is made up for where so much may stay owed; without that it is lost.
TEST(Pacer, AsMuchAsMayStayOwedIsCaughtUp) {
  for (const double may : {1.0, 6.0}) {
    Pacer pacer(1.0 / 60.0);
    pacer.elapse(0.05);
    EXPECT_NEAR(pacer.frames_owed(), 3.0, 1e-9);
    pacer.give_up_rest(may);
    EXPECT_NEAR(pacer.frames_owed(), std::min(may, 3.0), 1e-9);
    EXPECT_EQ(run(pacer, 1.0 / 60.0, 1, 100), static_cast<int>(std::min(may, 3.0)) + 1);
  }
}

TEST(Pacer, ALongStallIsNotCaughtUp) {
  Pacer pacer(1.0 / 60.0);
  EXPECT_LE(run(pacer, 30.0, 1, 100000), static_cast<int>(Pacer::kLongest_s * 60.0) + 1);
}

// A frame of 1/60 s that takes 40 pictures of 1 s is 1/2400 of real time in each of them, not nothing in 39
// and 1/60 in one. A frame given up half-way leaves its half counted.
TEST(Pacer, AHeavyFrameCountsAsItIsComputed) {
  Pacer pacer(1.0 / 60.0);
  pacer.elapse(1.0);
  for (int frame = 0; frame < 2; ++frame) {
    pacer.begin_frame();
    for (int part = 1; part <= 40; ++part) {
      pacer.frame_reached(part / 2400.0);
      if (part == 40) pacer.frame_done();
      pacer.elapse(1.0);
      EXPECT_NEAR(pacer.real_time_factor(), 1.0 / 2400.0, 1e-9) << part;
      EXPECT_TRUE(pacer.slow_motion());
    }
  }
  pacer.begin_frame();
  pacer.frame_reached(1.0 / 2400.0);
  pacer.begin_frame();
  pacer.frame_reached(1.0 / 2400.0);
  pacer.elapse(1.0);
  EXPECT_NEAR(pacer.real_time_factor(), 2.0 / 2400.0, 1e-9);
}

TEST(Pacer, RestartForgetsTheDebt) {
  Pacer pacer(1.0 / 60.0);
  pacer.elapse(0.2);
  pacer.restart();
  EXPECT_FALSE(pacer.frame_due());
  EXPECT_EQ(pacer.real_time_factor(), 0.0);
}

}  // namespace
}  // namespace weft
