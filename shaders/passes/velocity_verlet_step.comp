#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Completes a velocity-Verlet step at its end point and drifts into the next one. `velocity` is the
// prediction that damping sees; half_velocity is what the particle moves with.
// Each invocation writes its own particles and reads of the others only what nobody writes: no races.
// Source: docs/solvers.md "velocity-verlet".
#include "../shared/velocity_verlet_step.glsl"
