// Every pass there is, one line each. Explicit list, no self-registration.
#pragma once
#include <span>

#include "passes/pass.h"

namespace weft {

extern const Pass integrate;                    ///< forces, kick, drift, contact: one substep
extern const Pass euler_step;                   ///< the same with the drift first
extern const Pass velocity_verlet_step;         ///< integrate with a predicted velocity for the damping
extern const Pass verlet_step;                  ///< two positions in place of position and velocity
extern const Pass trapezoid_predict;            ///< an Euler step to the trapezoid's far end
extern const Pass trapezoid_correct;            ///< the step with the mean of both slopes
extern const Pass rk4_first;                    ///< Runge-Kutta's first stage
extern const Pass rk4_middle;                   ///< its second and third
extern const Pass rk4_last;                     ///< its last, and the step
extern const Pass xpbd_predict;                 ///< XPBD: where each particle would go by itself
extern const Pass xpbd_spring;                  ///< XPBD: the springs of one colour
extern const Pass xpbd_bend;                    ///< XPBD: the bending triples of one colour
extern const Pass xpbd_tethers;                 ///< XPBD: no farther from a pin than the cloth is long
extern const Pass xpbd_finish;                  ///< XPBD: velocities and contact
extern const Pass integrate_compensated;        ///< f32k
extern const Pass velocity_verlet_compensated;  ///< f32k
extern const Pass present;                      ///< f64: what is drawn, in float
extern const Pass normals;                      ///< vertex normals from the adjacent triangles

extern const Pass aerodynamics;                ///< drag and lift by triangle
extern const Pass solid_contact;               ///< contact with capsules, boxes and a tilted floor
extern const Pass mesh_contact;                ///< contact with meshes
extern const Pass pin_release;                 ///< what pins let go of gets its mass back
extern const Pass pin_place;                   ///< what moving pins hold, put where these are
extern const Pass xpbd_pins;                   ///< XPBD: how far they move it
extern const Pass tear;                        ///< links that are too long break
extern const Pass aerodynamics_torn;           ///< aerodynamics of whole triangles only
extern const Pass integrate_torn;              ///< integrate's work once a link is broken
extern const Pass integrate_torn_compensated;  ///< f32k
extern const Pass normals_torn;                ///< normals with whole triangles only
extern const Pass torn_mesh;                   ///< what of a torn cloth is drawn
extern const Pass strain_limit;                ///< springs of one colour that are too long, pulled back
extern const Pass watch;       ///< divergence: the fastest particle and the energy of each piece
extern const Pass judge;       ///< whether the state is sound
extern const Pass keep_sound;  ///< the last state that was

extern const Pass carry;            ///< self-collision: the motion that all of the cloth shares
extern const Pass pair_check;       ///< self-collision: keeps motion in its room; do the lists still hold
extern const Pass cell_count;       ///< particles of each bucket of the grid
extern const Pass cell_scan;        ///< counts to the ends of the buckets
extern const Pass cell_fill;        ///< particles into the buckets
extern const Pass cell_sort;        ///< in ascending order
extern const Pass patch_near;       ///< which patches of the cloth may have another near
extern const Pass pair_gather;      ///< lists of pairs within limit and skin
extern const Pass surface_gather;   ///< lists of near triangles and edges
extern const Pass touch_weight;     ///< pairs nearer than their limit
extern const Pass surface_touch;    ///< distances of near triangles and edges
extern const Pass surface_contact;  ///< what those that touch give their particles
extern const Pass self_contact;     ///< pushes them apart
extern const Pass spread_look;      ///< self-collision: is the cloth spread out, so that it has nothing to do

/// Whether the pass is one of the three that look for divergence at every frame's end.
bool watches(const Pass& pass);

/// Whether the pass is one of those that a frame of a plan with self-collision leaves out while the cloth
/// stays spread out: they look, or change velocities where surfaces are near.
bool serves_self_collision(const Pass& pass);

/// All of them; `validate` walks this list.
std::span<const Pass* const> passes();

}  // namespace weft
