// Bands wait by flags of their neighbours instead of a barrier of all: a fifth of a microsecond, and a thread
// that is held up delays only those next to it. Over many substeps it delays all, and then gets fewer rows.
#include "native/bands.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <utility>

namespace weft::native {

namespace {

constexpr std::uint32_t kTimedEvery = 4;  // substeps: the clock costs as much as a row of 16 particles
constexpr double kLearnAfter_s = 0.005;   // of timed work a thread: some 20 ms of sweeping

constexpr std::size_t kRowsFetchedAhead = 4;  // two that read what is fetched, two while it comes

inline void prefetch_to_write(const float* place) {
#if defined(__x86_64__)
  asm volatile("prefetchw (%0)" : : "r"(place));  // without the processor's support it does nothing
#else
  __builtin_prefetch(place, 1);
#endif
}

}  // namespace

/// Counts the time between its stops and goings on, if at all.
class Bands::StopWatch {
 public:
  explicit StopWatch(bool counts) : counts_(counts) { go_on(); }
  void go_on() {
    if (counts_) began_ = Clock::now();
  }
  void stop() {
    if (counts_) seconds_ += std::chrono::duration<double>(Clock::now() - began_).count();
  }
  double seconds() const { return seconds_; }

 private:
  using Clock = std::chrono::steady_clock;
  bool counts_;
  Clock::time_point began_;
  double seconds_ = 0;
};

Bands::Bands(Cloth& cloth, const Kernels& kernels, ThreadSpeeds& speeds, std::uint32_t count,
             float* half_velocity, const BodyTouch* bodies)
    : cloth_(cloth),
      kernels_(kernels),
      speeds_(speeds),
      half_velocity_(half_velocity),
      bodies_(bodies),
      patience_(patience_of(count)) {
  for (std::uint32_t b = 0; b < count; ++b) {
    auto band = std::make_unique<Band>();
    band->carried = make_floats(6 * cloth.sheet().stride);
    if (cloth.variant() & kContact) band->put_off = make_floats(put_off_floats(cloth.sheet().stride));
    if (bodies != nullptr) band->drifted.resize(BodyTouch::room(cloth.nx()));
    if (count > 1) band->handed = make_floats(2 * 4 * cloth.row_floats());
    bands_.push_back(std::move(band));
  }
  divide();
}

/// Rows to bands, as the speeds are now.
void Bands::divide() {
  divided_by_ = speeds_.version();
  const std::vector<std::size_t> borders = band_borders(cloth_, speeds_.of(count()));
  for (std::uint32_t b = 0; b < count(); ++b) {
    Band& band = *bands_[b];
    band.parts.clear();
    cloth_.in_each_cloth(borders[b], borders[b + 1],
                         [&](const ClothRows& part) { band.parts.push_back(part); });
    band.rows = cloth_.padded_rows();
    band.first = cloth_.padded_place(borders[b]);
    band.last = cloth_.padded_place(borders[b + 1]);
    band.goes_on_above = borders[b] % cloth_.ny() != 0;
    band.goes_on_below = borders[b + 1] % cloth_.ny() != 0;
  }
}

/// What was timed, once it is enough to say something.
void Bands::learn() {
  double busy_s = 0;
  for (const auto& band : bands_) busy_s += band->work.busy_s;
  const auto untimed = [](const auto& band) { return band->work.busy_s <= 0; };
  if (busy_s < kLearnAfter_s * count() || std::ranges::any_of(bands_, untimed)) return;
  std::vector<ThreadWork> work;
  for (const auto& band : bands_) work.push_back(std::exchange(band->work, {}));
  speeds_.learn(work);
}

float* Bands::handed_row(const Band& band, std::size_t copy, std::size_t row) const {
  return band.handed.get() + (4 * copy + row) * cloth_.row_floats();
}

void Bands::hand_on(Band& band, std::uint32_t substep) {
  const std::size_t copy = substep % 2, stride = cloth_.sheet().stride;
  const auto hand = [&](std::size_t to, std::size_t from) {
    float *const end = handed_row(band, copy, to), *const rows = band.rows[from];
    // Pads never change: both copies have them after the first two substeps.
    if (substep < 2) return void(std::memcpy(end, rows, 2 * cloth_.row_floats() * sizeof(float)));
    for (std::size_t at = kColumns; at < 2 * cloth_.row_floats(); at += stride)
      std::memcpy(end + at, rows + at, cloth_.nx() * sizeof(float));
  };
  if (band.goes_on_above) hand(0, band.first);
  if (band.goes_on_below) hand(2, band.last - 2);
}

/// Asks for two rows that another core has just written, all at once: one after the other, as they are used,
/// they would take longer than the rows themselves.
void Bands::fetch(const float* rows) const {
  constexpr std::size_t kLine = 64 / sizeof(float);
  for (std::size_t at = 0; at < 2 * cloth_.row_floats(); at += kLine) __builtin_prefetch(rows + at);
}

void Bands::take_above(std::uint32_t own, std::uint32_t substep) {
  Band& band = *bands_[own];
  if (!band.goes_on_above) return;
  wait_for(bands_[own - 1]->done, substep + 1, patience_.for_neighbour);
  for (std::size_t r = 0; r < 2; ++r)
    band.rows[band.first - 2 + r] = handed_row(*bands_[own - 1], substep % 2, 2 + r);
  fetch(band.rows[band.first - 2]);
}

void Bands::take_below(std::uint32_t own, std::uint32_t substep) {
  Band& band = *bands_[own];
  wait_for(bands_[own + 1]->done, substep + 1, patience_.for_neighbour);
  for (std::size_t r = 0; r < 2; ++r) band.rows[band.last + r] = handed_row(*bands_[own + 1], substep % 2, r);
  fetch(band.rows[band.last]);
}

void Bands::sweep_rows(Band& band, const ClothRows& rows, bool goes_on, const Kick& kick) {
  if (rows.first == rows.last) return;
  float* half_velocity = half_velocity_;
  if (half_velocity != nullptr) half_velocity += rows.cloth * cloth_.ny() * 3 * cloth_.sheet().stride;
  kernels_.sweep[cloth_.variant()]({.sheet = cloth_.sheet_of(rows.cloth),
                                    .outside = cloth_.outside(),
                                    .kick = &kick,
                                    .rows = band.rows.data() + rows.cloth * cloth_.padded_ny(),
                                    .first = rows.first,
                                    .last = rows.last,
                                    .goes_on = goes_on,
                                    .carried = band.carried.get(),
                                    .half_velocity = half_velocity,
                                    .bodies = bodies_ ? bodies_->bodies(band.drifted.data()) : Bodies{},
                                    .leap = watch_ ? LeapAsked{watch_->leap2(), &band.leapt} : LeapAsked{},
                                    .kicks = asks_kicks_ ? band.kicks : nullptr,
                                    .put_off = band.put_off.get()});
}

/// Begins to take back from the neighbours' cores what hand_on will write, in time: they have read it.
void Bands::claim_handed(const Band& band, std::uint32_t substep) const {
  constexpr std::size_t kLine = 64 / sizeof(float);
  const auto claim = [&](std::size_t row) {
    float* const rows = handed_row(band, substep % 2, row);
    for (std::size_t at = 0; at < 2 * cloth_.row_floats(); at += kLine) prefetch_to_write(rows + at);
  };
  if (band.goes_on_above) claim(0);
  if (band.goes_on_below) claim(2);
}

/// All of a band's rows, those above the ones it reads from below first.
void Bands::sweep_once(std::uint32_t own, std::uint32_t substep, const Kick& kick, StopWatch& busy) {
  Band& band = *bands_[own];
  for (const ClothRows& part : band.parts) {
    const bool waits = band.goes_on_below && &part == &band.parts.back();
    ClothRows rows = part;
    if (waits) rows.last = std::max(part.first, part.last - std::min(part.last, kRowsFetchedAhead));
    sweep_rows(band, rows, false, kick);
    if (!waits) continue;
    busy.stop();
    take_below(own, substep);
    busy.go_on();
    claim_handed(band, substep + 1);
    sweep_rows(band, {part.cloth, rows.last, part.last}, rows.last > rows.first, kick);
  }
}

void Bands::sweep_band(std::uint32_t own, std::span<const Kick> kicks) {
  Band& band = *bands_[own];
  hand_on(band, 0);
  raise(band.done, 1);
  for (std::uint32_t s = 0; s < kicks.size(); ++s) {
    take_above(own, s);
    StopWatch busy(count() > 1 && s % kTimedEvery == 0);
    sweep_once(own, s, kicks[s], busy);
    hand_on(band, s + 1);
    busy.stop();
    raise(band.done, s + 2);
    if (busy.seconds() == 0) continue;
    band.work.busy_s += busy.seconds();
    for (const ClothRows& part : band.parts) band.work.rows += static_cast<double>(part.last - part.first);
  }
}

void Bands::sweep(Crew& crew, std::span<const Kick> kicks, LeapWatch* watch, float* kick2) {
  watch_ = watch;
  asks_kicks_ = kick2 != nullptr;
  if (divided_by_ != speeds_.version()) divide();
  for (const auto& band : bands_) {
    band->done.store(0, std::memory_order_relaxed);
    band->leapt = 0;
    std::ranges::fill(band->kicks, 0.0f);
  }
  crew.run(count(), [&](std::uint32_t own) { sweep_band(own, kicks); });
  for (const auto& band : bands_) {
    if (band->leapt != 0) watch_->tell_leap();
    if (kick2 != nullptr) *kick2 = std::max(*kick2, *std::ranges::max_element(band->kicks));
  }
  if (watch_ && !kicks.empty())
    watch_->tell_sweeps(static_cast<std::uint32_t>(kicks.size()), kicks.back().drift);
  learn();
}

void Bands::surface(Crew& crew, const Surface& wanted) {
  const std::vector<float*> rows = cloth_.padded_rows();
  const auto from = [](float* all, std::size_t floats) { return all == nullptr ? nullptr : all + floats; };
  crew.run(count(), [&](std::uint32_t own) {
    for (const ClothRows& part : bands_[own]->parts) {
      const std::size_t row = part.cloth * cloth_.ny(), particle = row * cloth_.nx();
      kernels_.surface({.stride = cloth_.sheet().stride,
                        .nx = cloth_.nx(),
                        .ny = cloth_.ny(),
                        .first = part.first,
                        .last = part.last,
                        .rows = rows.data() + part.cloth * cloth_.padded_ny(),
                        .relative_inverse_mass = cloth_.relative_inverse_mass().data() + particle,
                        .position = wanted.position + 4 * particle,
                        .velocity = from(wanted.velocity, 4 * particle),
                        .normal = from(wanted.normal, 4 * particle)});
    }
  });
}

}  // namespace weft::native
