// Every solver, one line each; solvers.cpp puts them in the order that people see.
#pragma once
#include "solvers/solver.h"

namespace weft {

extern const Solver leapfrog;  ///< kick–drift, second order: the default
extern const Solver rk4;       ///< classical Runge–Kutta: the converged truth, CPU only

}  // namespace weft
