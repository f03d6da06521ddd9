// Every solver, one line each; solvers.cpp puts them in the order that people see.
#pragma once
#include "solvers/solver.h"

namespace weft {

extern const Solver leapfrog;          ///< kick–drift, second order: the default
extern const Solver velocity_verlet;   ///< leapfrog that damps with a predicted velocity
extern const Solver symplectic_euler;  ///< kick–drift without half kicks, first order
extern const Solver verlet;            ///< positions only, as cloth demos teach it
extern const Solver euler;             ///< explicit Euler: shown because it fails
extern const Solver trapezoid;         ///< Heun's method, second order
extern const Solver rk4;               ///< classical Runge–Kutta: the converged truth
extern const Solver xpbd;              ///< position-based in small steps: fast, stable, too soft

}  // namespace weft
