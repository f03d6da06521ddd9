// The coefficients of a cloth's particles in blocks of sixteen columns, equal ones held once: some twenty
// blocks for a whole cloth, and one more for each new pattern of pins and broken links.
#pragma once
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "model/model.h"
#include "native/kernel.h"
#include "passes/coefficients.h"

namespace weft::native {

/// What changes while a cloth is simulated: who is fixed, and which links are broken.
struct ClothChanges {
  std::span<const float> relative_inverse_mass;  ///< by particle
  std::span<const std::uint32_t> broken_links;   ///< by particle, as in model/links.h; empty: all are whole
};

class Blocks {
 public:
  Blocks(const Model& model, const ClothChanges& now);

  const Block* data() const { return blocks_.data(); }
  const std::uint32_t* of() const { return of_.data(); }  ///< by row of all cloths, and block
  std::size_t per_row() const { return per_row_; }
  std::size_t distinct() const { return blocks_.size(); }
  std::uint64_t bytes() const;
  /// Finds or makes the block of sixteen columns anew; data() and of() may be others afterwards.
  void refresh(std::size_t j, std::size_t b, const ClothChanges& now);
  /// The blocks of a particle and its eight neighbours, which a link that breaks there changes; the rows
  /// above and below may be another cloth's, whose blocks become what they were.
  void refresh_around(std::uint32_t particle, const ClothChanges& now);

 private:
  Block make(std::size_t j, std::size_t b, const ClothChanges& now) const;
  const glm::vec4* find(PairName pair, std::size_t i, std::size_t row_of_all, const ClothChanges& now) const;

  Grid grid_;
  SpringRows<float> rows_;
  float interior_;  ///< inverse mass of an interior particle [1/kg]
  std::size_t per_row_;
  std::vector<Block> blocks_;
  std::vector<std::uint32_t> of_;
  std::map<std::string, std::uint32_t> known_;  ///< a block's bytes → its place
};

}  // namespace weft::native
