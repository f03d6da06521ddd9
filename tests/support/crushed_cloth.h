// A cloth crushed into itself in empty space, and what leapfrog makes of its energy: the numbers of
// docs/stability.md "Where no bound holds".
#pragma once
#include <cstdint>
#include <string>

namespace weft::hard {

/// A cloth of 0.1 m cells, 12 rows and no outside force, whose particles begin off their places.
struct Crushed {
  std::uint32_t columns;
  double off_cells;         ///< standard deviation of the distance from the place
  double damping_ratio;     ///< of every spring
  bool sheared = true;      ///< without shear springs the step bound is sharp
  double step_share = 0.9;  ///< of the largest stable step; 0.9 is what is chosen automatically
};

struct Crush {
  double most_energy = 0.0;  ///< at any frame's end, over that of the start
  std::string cause;         ///< where the run was stopped
};

/// Leapfrog in double for the time of 10 000 automatic substeps.
Crush run_crushed(const Crushed&);

}  // namespace weft::hard
