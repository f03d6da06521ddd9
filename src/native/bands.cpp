// Bands wait by flags of their neighbours instead of a barrier of all: a fifth of a microsecond, and a thread
// that is held up delays only those next to it.
#include "native/bands.h"

#include <cstring>

namespace weft::native {

Bands::Bands(Cloth& cloth, const Kernels& kernels, std::uint32_t count, float* half_velocity)
    : cloth_(cloth), kernels_(kernels), half_velocity_(half_velocity) {
  for (std::uint32_t b = 0; b < count; ++b) {
    auto band = std::make_unique<Band>();
    band->first = b * cloth.ny() / count;
    band->last = (b + 1) * cloth.ny() / count;
    for (std::size_t j = 0; j < cloth.ny() + 2; ++j) band->rows.push_back(cloth.row(j));
    band->carried = make_floats(6 * cloth.sheet().stride);
    if (count > 1) band->handed = make_floats(2 * 4 * cloth.row_floats());
    bands_.push_back(std::move(band));
  }
}

float* Bands::handed_row(const Band& band, std::size_t copy, std::size_t row) const {
  return band.handed.get() + (4 * copy + row) * cloth_.row_floats();
}

void Bands::hand_on(Band& band, std::size_t copy) {
  const std::size_t bytes = 2 * cloth_.row_floats() * sizeof(float);
  std::memcpy(handed_row(band, copy, 0), cloth_.row(band.first), bytes);
  std::memcpy(handed_row(band, copy, 2), cloth_.row(band.last - 2), bytes);
}

void Bands::take_neighbours(std::uint32_t own, std::size_t copy) {
  Band& band = *bands_[own];
  for (std::size_t r = 0; r < 2; ++r) {
    if (own > 0) band.rows[band.first - 2 + r] = handed_row(*bands_[own - 1], copy, 2 + r);
    if (own + 1 < count()) band.rows[band.last + r] = handed_row(*bands_[own + 1], copy, r);
  }
}

void Bands::sweep_band(std::uint32_t own, std::span<const Kick> kicks) {
  Band& band = *bands_[own];
  Sweep sweep{.sheet = cloth_.sheet(),
              .outside = cloth_.outside(),
              .rows = band.rows.data(),
              .first = band.first,
              .last = band.last,
              .carried = band.carried.get(),
              .half_velocity = half_velocity_};
  const auto await_neighbour = [&](std::uint32_t neighbour, std::uint32_t states) {
    if (neighbour < count()) wait_for(bands_[neighbour]->done, states);
  };
  const bool alone = count() == 1;
  if (!alone) hand_on(band, 0);
  raise(band.done, 1);
  for (std::uint32_t s = 0; s < kicks.size(); ++s) {
    await_neighbour(own - 1, s + 1);
    await_neighbour(own + 1, s + 1);
    if (!alone) take_neighbours(own, s % 2);
    sweep.kick = &kicks[s];
    kernels_.sweep[cloth_.variant()](sweep);
    if (!alone) hand_on(band, (s + 1) % 2);
    raise(band.done, s + 2);
  }
}

void Bands::sweep(Crew& crew, std::span<const Kick> kicks) {
  for (const auto& band : bands_) band->done.store(0, std::memory_order_relaxed);
  crew.run(count(), [&](std::uint32_t own) { sweep_band(own, kicks); });
}

void Bands::surface(Crew& crew, const Surface& wanted) {
  std::vector<const float*> rows;
  for (std::size_t j = 0; j < cloth_.ny() + 2; ++j) rows.push_back(cloth_.row(j));
  crew.run(count(), [&](std::uint32_t own) {
    Surface part = wanted;
    part.stride = cloth_.sheet().stride;
    part.nx = cloth_.nx();
    part.ny = cloth_.ny();
    part.first = bands_[own]->first;
    part.last = bands_[own]->last;
    part.rows = rows.data();
    part.relative_inverse_mass = cloth_.relative_inverse_mass().data();
    kernels_.surface(part);
  });
}

}  // namespace weft::native
