// The text above the tables of docs/stability.md.
#pragma once

namespace weft::hard {

inline constexpr const char* kHead = R"(# What the hard cases come to

`scripts/stability` writes this page: scenes made to break a simulation, with every solver of `weft
solvers`, on the CPU reference, on the CPU's vector units where these run the solver, and on a Vulkan
device, at the automatic number of substeps. A solver added to the list appears here by itself, and so does
an effect: the cases `effect-…` are made of the list of effects and the table of parameters.
tests/hard_cases holds the default solver, leapfrog, to its promises on each of them: every case finite,
nobody inside a single collider by more than 1 % of its radius, nobody through it, no energy out of
nothing, a free cloth's momentum at round-off.

*detected*: the run stopped at that frame, because the state was no longer sound
([physics.md](physics.md) "Divergence"); the columns then hold up to the frame before. *stretch*: most
of a structural spring at any frame's end. *energy*: most above the start's, over what was stored or
could fall at the start; only where nothing moves and no wind blows. *inside*: deepest in a collider, of
its inner radius (half of what it is thick where it is thickest), or below the floor, of the cloth's width.
*tunnelled*: particles that went through a collider from one frame's end to the next; without meaning in
`effect-…`, where bodies are put over the cloth. *time*: of the run, reading every frame back included, on a
busy machine: compare orders of magnitude.

**Reported, not hidden.** Leapfrog's answer to 100 m/s of wind on cloth of 1 kN/m is a large stretch,
since the wind pulls with kilonewtons; to a yank of 600 m/s, and to pins three widths apart, too.
Explicit Euler is unstable at every step and the trapezoid rule without damping: they are there to be
found out, and are wherever it comes to show. XPBD is finite at any step and too soft: where leapfrog
stretches by percents it stretches by tens of them, in frames of a second by far more; *energy* beside
it is what the real springs would store at that stretch.

**Fast bodies.** A sphere, capsule, box or mesh may be shot through the cloth, and the cloth dropped on it, at
any speed the reader takes: contact is swept, nobody goes through, and what enters goes on along the surface
as its velocity does. Held at 10 and 100 m/s here. Not promised: that a body which turns by more than 60° in
a substep meets what it passes over, that a mesh thinner than a cell of its grid is met, and that a gap
between particles wider than the body is closed; links are no colliders.

**Limits.** A strain limit (`limited-…`) is one sweep a substep, which passes a pull on by a few springs: most
stretch may be far beyond the limit for some frames, and what hangs is lifted by it, by up to some hundredths
of what could fall.

**The wedge.** Where two colliders overlap, or one and the floor, contact serves one after the other. A
particle may then be inside one by as much as the other pushes it back in; it is pushed out as soon as
one lets go, and stays finite meanwhile.

**Beyond this page.** The long suite (`test_hard_cases_long`, `scripts/test --full`) runs 1024 × 1024 at 20
kN/m onto a sphere for 0.1 s, and scene 1 with gusts at 32 × 32 for ten minutes, after which pins have not
moved by a bit, energy is bounded and memory constant. On 2026-11-22 both held: the first natively in 20
minutes, the second on llvmpipe in 9, on 4 cores at a load of 20. 20 000 random scenes, with every section
and number of the parameter table, and 600 random walks of 60 frames each over the sliders and switches of
every effect stayed finite (`test_hard_cases`, CPU reference, 2026-11-22); 3 of the walks ended where the last
section says.

**Other grids.** Where the resolution changes, the cloth is carried over as in the window (displacement
and velocity, bicubic). Interpolating changes the energy by what the other grid cannot show; *energy*
there counts what the solver made between the changes.
)";

}  // namespace weft::hard
