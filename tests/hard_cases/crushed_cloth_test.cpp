// What happens where neighbours fly over one another within a substep, and that a little damping is enough:
// the numbers of docs/stability.md "Where no bound holds".
#include "support/crushed_cloth.h"

#include <gtest/gtest.h>

#include "model/measures.h"

namespace weft::hard {
namespace {

// Leapfrog conserves a neighbour of the energy within (ωh/2)² of it: here ωh is at most 1.5, and at the start
// all of the energy is stored, so that it can swing up by 1/(1 − 0.56) at the very most. Without damping that
// holds up to springs that are a third longer or shorter, on ribbons of two columns as on wider cloths.
TEST(CrushedCloth, UndampedKeepsItsEnergyWhileNeighboursKeepTheirSides) {
  for (const std::uint32_t columns : {2u, 3u, 8u})
    EXPECT_LT(run_crushed({columns, 0.2, 0.0}).most_energy, 1.2) << columns;
}

// Three hundredths of the critical damping take more than flying over one another gives, even where the bound
// is sharp; the default is a tenth.
TEST(CrushedCloth, ThreeHundredthsOfTheCriticalDampingCoolAnyCrush) {
  for (const std::uint32_t columns : {2u, 8u})
    for (const bool sheared : {true, false})
      for (const double off_cells : {0.5, 1.0, 4.7}) {
        const Crush crush = run_crushed({columns, off_cells, kDampingRatioEnough, sheared});
        EXPECT_LT(crush.most_energy, 1.2) << columns << " columns, " << off_cells << " cells, " << sheared;
      }
}

// The law's other side, so that the page tells the truth: crushed and undamped, every cloth gains energy at
// the automatic step, not the ribbon alone. That is found out (exit 4), with its cause.
TEST(CrushedCloth, WithoutDampingCrushedClothGainsEnergyWhateverItsWidth) {
  for (const std::uint32_t columns : {2u, 3u, 8u}) {
    const Crush crush = run_crushed({columns, 1.0, 0.0});
    EXPECT_GT(crush.most_energy, 16.0) << columns;
    EXPECT_NE(crush.cause.find("damping"), std::string::npos) << columns << ": " << crush.cause;
  }
}

}  // namespace
}  // namespace weft::hard
