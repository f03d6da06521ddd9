// The hard cases: scenes of tests/hard_cases with what a scene file cannot say (starts, masses, hands), run
// with any solver on any device and measured at every frame's end. The tests judge them, and
// docs/stability.md is written from them.
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sim/simulation.h"

namespace weft::hard {

enum class Start { scene, point, speck, line, box, inside_out, falling_30, swinging };
enum class Masses { scene, one_heavy, one_light, checkered };

/// What happens before a frame, other than what the scene says.
enum class Hand { none, sweeps_parameters, changes_resolution, sweeps_effect };

struct HardCase {
  std::string name;                   ///< a word
  std::string about;                  ///< what is hard, one sentence without a full stop
  std::string scene;                  ///< tests/hard_cases/NAME.toml
  std::vector<std::string> set = {};  ///< overrides of it
  double time_s = 0.2;
  Start start = Start::scene;
  Masses masses = Masses::scene;
  double mass_ratio = 1.0;
  Hand hand = Hand::none;
  std::string effect = {};  ///< of scene/effects.h, that is added to the scene; empty: none
  std::string solver = {};  ///< that is held to the promises; empty: leapfrog
  bool closed = false;      ///< nothing moves and no wind blows: no energy may come from anywhere
  /// Of what was stored or could fall. Leapfrog conserves a neighbour of the energy, not the energy itself.
  double energy_tolerance = 0.01;
  bool one_collider = false;    ///< every particle can be outside: it has to be
  bool quick = true;            ///< a second or less with the default solver
  bool quick_on_device = true;  ///< likewise on a software device; else the long tests run it there
};

/// Every case, in the order of docs/stability.md.
std::span<const HardCase> hard_cases();

/// The solver that a case holds to the promises: leapfrog, but where only another has the effect.
const Solver& held_solver(const HardCase&);

struct Outcome {
  std::optional<Divergence> divergence;
  std::string cause;            ///< of the divergence, in words
  std::uint32_t substeps = 0;   ///< a frame
  double max_stretch = 0.0;     ///< of a structural spring, at any frame's end
  double energy_gain = 0.0;     ///< most energy above the start's, over energy_scale_j
  double energy_scale_j = 0.0;  ///< what was stored or could fall at the start
  double inside = 0.0;  ///< deepest into a sphere, over its radius, or below the floor over the cloth's width
  std::uint32_t tunnelled =
      0;  ///< particles that passed through a sphere or the floor between two frames' ends
  double momentum_drift = 0.0;  ///< of a free cloth without forces, over mass times fastest particle
  double wall_s = 0.0;
  Model model;  ///< that the run ended with
  State end;    ///< the last good one where it diverged
};

/// Makes the simulation that a run uses: on the CPU or on a device.
using MakeSimulation = std::function<std::unique_ptr<Simulation>(const Model&, const Solver&)>;

Model hard_model(const HardCase&, std::span<const std::string> more = {});
State hard_start(const HardCase&, const Model&);
/// What the solver has no passes for at the case's start or once its sliders move; empty when it can run it.
std::string what_solver_lacks(const HardCase&, const Solver&);
Outcome run_hard_case(const HardCase&, const Solver&, const MakeSimulation&);

}  // namespace weft::hard
