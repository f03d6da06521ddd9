// Bands wait by flags of their neighbours instead of a barrier of all: a fifth of a microsecond, and a thread
// that is held up delays only those next to it.
#include "native/bands.h"

#include <cstring>

namespace weft::native {

std::size_t band_border(const Cloth& cloth, std::size_t b, std::size_t count) {
  const std::size_t row = b * cloth.rows() / count, within = row % cloth.ny();
  if (within == 1) return row - 1;
  return within > 1 && within + 1 == cloth.ny() ? row + 1 : row;
}

Bands::Bands(Cloth& cloth, const Kernels& kernels, std::uint32_t count, float* half_velocity)
    : cloth_(cloth), kernels_(kernels), half_velocity_(half_velocity) {
  for (std::uint32_t b = 0; b < count; ++b) {
    auto band = std::make_unique<Band>();
    const std::size_t first = band_border(cloth, b, count), last = band_border(cloth, b + 1, count);
    cloth.in_each_cloth(first, last, [&](const ClothRows& part) { band->parts.push_back(part); });
    band->rows = cloth.padded_rows();
    band->first = cloth.padded_place(first);
    band->last = cloth.padded_place(last);
    band->goes_on_above = first % cloth.ny() != 0;
    band->goes_on_below = last % cloth.ny() != 0;
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
  if (band.goes_on_above) std::memcpy(handed_row(band, copy, 0), band.rows[band.first], bytes);
  if (band.goes_on_below) std::memcpy(handed_row(band, copy, 2), band.rows[band.last - 2], bytes);
}

void Bands::take_neighbours(std::uint32_t own, std::size_t copy) {
  Band& band = *bands_[own];
  for (std::size_t r = 0; r < 2; ++r) {
    if (band.goes_on_above) band.rows[band.first - 2 + r] = handed_row(*bands_[own - 1], copy, 2 + r);
    if (band.goes_on_below) band.rows[band.last + r] = handed_row(*bands_[own + 1], copy, r);
  }
}

void Bands::sweep_rows(const Band& band, const Kick& kick) {
  for (const ClothRows& part : band.parts) {
    const std::size_t row = part.cloth * cloth_.ny();
    float* half_velocity = half_velocity_;
    if (half_velocity != nullptr) half_velocity += row * 3 * cloth_.sheet().stride;
    kernels_.sweep[cloth_.variant()]({.sheet = cloth_.sheet_of(part.cloth),
                                      .outside = cloth_.outside(),
                                      .kick = &kick,
                                      .rows = band.rows.data() + part.cloth * cloth_.padded_ny(),
                                      .first = part.first,
                                      .last = part.last,
                                      .carried = band.carried.get(),
                                      .half_velocity = half_velocity});
  }
}

void Bands::sweep_band(std::uint32_t own, std::span<const Kick> kicks) {
  Band& band = *bands_[own];
  hand_on(band, 0);
  raise(band.done, 1);
  for (std::uint32_t s = 0; s < kicks.size(); ++s) {
    if (band.goes_on_above) wait_for(bands_[own - 1]->done, s + 1);
    if (band.goes_on_below) wait_for(bands_[own + 1]->done, s + 1);
    take_neighbours(own, s % 2);
    sweep_rows(band, kicks[s]);
    hand_on(band, (s + 1) % 2);
    raise(band.done, s + 2);
  }
}

void Bands::sweep(Crew& crew, std::span<const Kick> kicks) {
  for (const auto& band : bands_) band->done.store(0, std::memory_order_relaxed);
  crew.run(count(), [&](std::uint32_t own) { sweep_band(own, kicks); });
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
