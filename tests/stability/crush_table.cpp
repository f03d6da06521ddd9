// Where the step bound does not bound the energy, with measured numbers.
#include "stability/crush_table.h"

#include <fmt/format.h>

#include <array>

#include "support/crushed_cloth.h"

namespace weft::hard {
namespace {

constexpr const char* kText = R"(
## Where no bound holds
The largest stable step bounds every oscillation of the springs, in any configuration, and damping. It
does not bound what happens where neighbours fly over one another within a substep: there a spring turns
about between two evaluations of its force, and what leapfrog conserves is no energy any more. That
takes springs pressed or pulled by about half their length and more, so neighbours that pass each other
at some half of the speed of sound in the cloth, √(Y/ρ): no cloth in daily life, but soft undamped cloth
that is crumpled by force can come to it.

Measured: a cloth of 12 rows in empty space whose particles begin off their places by a normal distance,
leapfrog in double for the time of 10 000 automatic substeps. The numbers are the most energy at any
frame's end, over the start's, also after the run would have been stopped; above 1 energy came from
nowhere. *share* is of the largest stable step
(automatic: 0.9), *ratio* the damping ratio.

)";

constexpr const char* kConclusion = R"(
- **Up to a fifth of a cell off, nothing is gained**, without damping and with two columns as with
  eight.
- **Half a cell or more off, every undamped cloth gains energy**, whatever its width; it is no matter of
  narrow ribbons and no resonance of one frequency. Cloth without shear springs gains it soonest,
  because there λ is the largest eigenvalue itself and not 1.5 times as much. Growth is that of a random
  walk: it slows down as the cloth gets hot, and ends in no overflow.
- **Smaller steps help, but no step ends it**: a third of the step gains some thousand times less, and
  not nothing. So a tighter bound, for ribbons or for all undamped cloth, would cost substeps and
  promise nothing.
- **A damping ratio of 0.03 ends it**, where the bound is sharp, too. By default structural springs of
  cotton have 0.1 at 64 × 64 and 0.06 at 16 × 16, so that this is met only by who turns damping off and
  crushes the cloth.

Therefore: undamped, crushed cloth is not promised to keep its energy. It stays finite; when it has 16
times the energy that its scene can have given it, the run stops with exit 4 and names the damping ratio
as the likely cause, with the cure ([physics.md](physics.md) "Divergence"); in the window, *restore the
last good state* goes back to before. tests/hard_cases/crushed_cloth_test.cpp holds all of this.
)";

std::string times(const Crushed& crushed) {
  const double most = run_crushed(crushed).most_energy;
  return most < 10.0 ? fmt::format("{:.2f}", most) : fmt::format("{:.0f}", most);
}

}  // namespace

std::string crush_section() {
  struct Column {
    const char* title;
    double off_cells, damping_ratio, step_share;
  };
  constexpr std::array kTries{Column{"0.2 cells off, undamped", 0.2, 0.0, 0.9},
                              Column{"0.5", 0.5, 0.0, 0.9},
                              Column{"1", 1.0, 0.0, 0.9},
                              Column{"4.7", 4.7, 0.0, 0.9},
                              Column{"1, share 0.6", 1.0, 0.0, 0.6},
                              Column{"1, share 0.3", 1.0, 0.0, 0.3},
                              Column{"1, ratio 0.01", 1.0, 0.01, 0.9},
                              Column{"1, ratio 0.03", 1.0, 0.03, 0.9},
                              Column{"4.7, ratio 0.03", 4.7, 0.03, 0.9}};
  std::string text = std::string(kText) + "| cloth |";
  for (const Column& column : kTries) text += fmt::format(" {} |", column.title);
  text += "\n|---|";
  for (std::size_t k = 0; k < kTries.size(); ++k) text += "---|";
  for (const bool sheared : {true, false})
    for (const std::uint32_t columns : {2u, 3u, 8u, 24u}) {
      text += fmt::format("\n| {} × 12{} |", columns, sheared ? "" : ", no shear springs");
      for (const Column& c : kTries)
        text += fmt::format(" {} |", times({columns, c.off_cells, c.damping_ratio, sheared, c.step_share}));
    }
  return fmt::format("{}\n{}", text, kConclusion);
}

}  // namespace weft::hard
