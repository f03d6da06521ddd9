// How rows are shared out to threads, on made-up machines whose speeds are known: no clock is read.
#include "native/thread_speeds.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "model/model.h"
#include "scene/reader.h"

namespace weft {
namespace {

using native::ThreadSpeeds;
using native::ThreadWork;

native::Cloth cloth_of(std::uint32_t resolution, std::uint32_t cloths = 1) {
  std::string further;
  for (std::uint32_t c = 1; c < cloths; ++c) further += fmt::format("{{center=[0,{},0]}},", c);
  const Model model = build_model(
      load_scene(find_scene("1"),
                 {{fmt::format("cloth.resolution={}", resolution), fmt::format("cloths=[{}]", further)}})
          .scene);
  return native::Cloth(model, {});
}

/// What each thread takes for a substep of its rows: those, and as long as three more for what it exchanges.
std::vector<ThreadWork> work_of(const std::vector<std::size_t>& borders, const std::vector<double>& speeds) {
  std::vector<ThreadWork> work;
  for (std::size_t t = 0; t + 1 < borders.size(); ++t) {
    const auto rows = static_cast<double>(borders[t + 1] - borders[t]);
    work.push_back({.rows = rows, .busy_s = (rows + 3) / speeds[t]});
  }
  return work;
}

// The slowest decides how long a substep takes. With speeds s and n rows in all no division takes less than
// (n + 3·threads) / sum s; one that rounds to rows at most a row of the slowest more.
TEST(NativeThreadSpeeds, BandsEndAtTheSameTimeAfterAFewRounds) {
  const native::Cloth cloth = cloth_of(64);
  const std::vector<double> truth{1.0, 0.7, 1.3, 0.75};
  ThreadSpeeds speeds;
  for (int round = 0; round < 12; ++round) speeds.learn(work_of(band_borders(cloth, speeds.of(4)), truth));
  const std::vector<ThreadWork> work = work_of(band_borders(cloth, speeds.of(4)), truth);
  const double bound = (64 + 3 * 4) / std::accumulate(truth.begin(), truth.end(), 0.0);
  EXPECT_LE(std::ranges::max(work, {}, &ThreadWork::busy_s).busy_s, bound + 1 / 0.7);
  // Equal bands would take (16 + 3) / 0.7: the gain is real, not within the rounding.
  EXPECT_LT(bound + 1 / 0.7, (16 + 3) / 0.7);
}

/// A thread that got no core for a while is not left with too few rows for ever: once it runs it is learnt
/// anew.
TEST(NativeThreadSpeeds, AThreadThatStoodStillComesBack) {
  const native::Cloth cloth = cloth_of(64);
  ThreadSpeeds speeds;
  const std::vector<double> even(4, 1.0), stood{1, 1, 1, 1e-6};
  for (int round = 0; round < 20; ++round) speeds.learn(work_of(band_borders(cloth, speeds.of(4)), stood));
  EXPECT_EQ(band_borders(cloth, speeds.of(4))[3], 64 - native::kRowsPerBandMin);
  for (int round = 0; round < 12; ++round) speeds.learn(work_of(band_borders(cloth, speeds.of(4)), even));
  const std::vector<std::size_t> borders = band_borders(cloth, speeds.of(4));
  EXPECT_NEAR(static_cast<double>(borders[4] - borders[3]), 16, 1);
}

/// Those who did not take part keep their place among the others: three threads' work says nothing of the
/// fourth.
TEST(NativeThreadSpeeds, WorkOfFewerThreadsLeavesTheOthersAsTheyWere) {
  ThreadSpeeds speeds({1.0, 1.0, 1.0, 0.5});
  speeds.learn({{{.rows = 10, .busy_s = 1}, {.rows = 10, .busy_s = 1}, {.rows = 10, .busy_s = 1}}});
  EXPECT_EQ(speeds.of(4), (std::vector<double>{1.0, 1.0, 1.0, 0.5}));
  EXPECT_EQ(speeds.of(2), (std::vector<double>{1.0, 1.0}));
}

/// Every row is in one band, no band is left without the two rows that it hands on at each end of a cloth
/// which goes on in its neighbour, and no border parts one row from its cloth.
TEST(NativeThreadSpeeds, BordersKeepWhatBandsNeed) {
  std::uint32_t seed = 1;
  const auto speed = [&] {
    return 0.01 + 1e-3 * static_cast<double>((seed = seed * 1664525u + 1013904223u) >> 22);
  };
  for (const std::uint32_t cloths : {1u, 3u})
    for (const std::uint32_t resolution : {16u, 17u, 37u, 64u}) {
      const native::Cloth cloth = cloth_of(resolution, cloths);
      for (std::uint32_t count = 1; count <= cloth.rows() / native::kRowsPerBandMin; ++count)
        for (int trial = 0; trial < 20; ++trial) {
          std::vector<double> speeds(count);
          for (double& s : speeds) s = speed();
          const std::vector<std::size_t> borders = band_borders(cloth, speeds);
          ASSERT_EQ(borders.size(), count + 1);
          ASSERT_EQ(borders.front(), 0u);
          ASSERT_EQ(borders.back(), cloth.rows());
          for (std::uint32_t b = 0; b < count; ++b) {
            ASSERT_GE(borders[b + 1], borders[b] + 2) << resolution << " " << cloths << " " << count;
            const std::size_t within = borders[b] % cloth.ny();
            ASSERT_NE(within, 1u);
            ASSERT_NE(within + 1, cloth.ny());
          }
        }
    }
}

}  // namespace
}  // namespace weft
