// The text above the tables of docs/stability.md.
#pragma once

namespace weft::hard {

inline constexpr const char* kHead = R"(# What the hard cases come to

`scripts/stability` writes this page: scenes made to break a simulation, with every solver of `weft
solvers`, on the CPU reference, on the CPU's vector units where these run the solver, and on a Vulkan
device, at the automatic number of substeps. A solver added to the list appears here by itself.
tests/hard_cases holds the default solver, leapfrog, to its promises on each of them: every case finite,
nobody inside a single collider by more than 1 % of its radius, nobody through it, no energy out of
nothing, a free cloth's momentum at round-off.

*detected*: the run stopped at that frame, because the state was no longer sound
([physics.md](physics.md) "Divergence"); the columns then hold up to the frame before. *stretch*: most
of a structural spring at any frame's end. *energy*: most above the start's, over what was stored or
could fall at the start; only where nothing moves and no wind blows. *inside*: deepest in a sphere, of
its radius, or below the floor, of the cloth's width. *tunnelled*: particles that went through a
collider from one frame's end to the next. *time*: of the run, reading every frame back included, on a
busy machine: compare orders of magnitude.

**Reported, not hidden.** Leapfrog's answer to 100 m/s of wind on cloth of 1 kN/m is a large stretch,
since the wind pulls with kilonewtons; to a yank of 600 m/s, and to pins three widths apart, too.
Explicit Euler is unstable at every step and the trapezoid rule without damping: they are there to be
found out, and are wherever it comes to show. XPBD is finite at any step and too soft: where leapfrog
stretches by percents it stretches by tens of them, in frames of a second by far more; *energy* beside
it is what the real springs would store at that stretch.

**The wedge.** Where two colliders overlap, or one and the floor, contact serves one after the other. A
particle may then be inside one by as much as the other pushes it back in; it is pushed out as soon as
one lets go, and stays finite meanwhile.

**Other grids.** Where the resolution changes, the cloth is carried over as in the window (displacement
and velocity, bicubic). Interpolating changes the energy by what the other grid cannot show; *energy*
there counts what the solver made between the changes.
)";

}  // namespace weft::hard
