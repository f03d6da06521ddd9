// Speeds fade into each other slowly enough that one interruption moves few rows, and fast enough that a
// neighbour who comes or goes is followed within some tenths of a second.
#include "native/thread_speeds.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace weft::native {
namespace {

constexpr double kLearnt = 0.5;     // of the new in what is known
constexpr double kSlowest = 0.125;  // of the mean: a thread that got no core at all comes back by itself

}  // namespace

void ThreadSpeeds::learn(std::span<const ThreadWork> work) {
  if (speed_.size() < work.size()) speed_.resize(work.size(), 1.0);
  double sum = 0, known = 0;
  for (std::size_t t = 0; t < work.size(); ++t) {
    sum += work[t].rows / work[t].busy_s;
    known += speed_[t];
  }
  // Relative to the same threads' mean before, so that threads that did not take part keep their place.
  for (std::size_t t = 0; t < work.size(); ++t) {
    const double now = work[t].rows / work[t].busy_s * known / sum;
    speed_[t] = std::max((1 - kLearnt) * speed_[t] + kLearnt * now, kSlowest);
  }
  ++version_;
}

std::vector<double> ThreadSpeeds::of(std::uint32_t count) const {
  std::vector<double> speeds(count, 1.0);
  std::copy_n(speed_.begin(), std::min<std::size_t>(count, speed_.size()), speeds.begin());
  return speeds;
}

std::vector<std::size_t> band_borders(const Cloth& cloth, std::span<const double> speeds) {
  const double all = std::accumulate(speeds.begin(), speeds.end(), 0.0);
  const std::size_t rows = cloth.rows(), count = speeds.size();
  const std::size_t least = std::min<std::size_t>(kRowsPerBandMin, rows / count);
  std::vector<std::size_t> borders(count + 1, 0);
  double before = 0;
  for (std::size_t b = 1; b < count; ++b) {
    before += speeds[b - 1];
    const auto wanted = static_cast<std::size_t>(std::lround(static_cast<double>(rows) * before / all));
    // After a border that went down a row the lower bound may lie above the upper one, which then counts.
    const std::size_t row = std::min(std::max(wanted, borders[b - 1] + least), rows - (count - b) * least);
    const std::size_t within = row % cloth.ny();
    borders[b] = row;
    if (within == 1) --borders[b];
    if (within > 1 && within + 1 == cloth.ny()) ++borders[b];
  }
  borders[count] = rows;
  return borders;
}

}  // namespace weft::native
