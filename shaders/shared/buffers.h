// The buffer dictionary: one row a buffer. Both languages, the plan's byte counts, Vulkan object
// names and the validator's reports come from here. `READS`/`WRITES` in pass.glsl use the bindings.
#ifndef WEFT_SHARED_BUFFERS_H
#define WEFT_SHARED_BUFFERS_H

// ROW(name, binding, element, unit); how many elements: src/plan/buffers.cpp
#define WEFT_BUFFERS(ROW)                                                                              \
  ROW(params, 0, Params, "the parameter block")                                                        \
  ROW(substeps, 1, real4, "per-dispatch rows: kick, drift, wind, collider places (params.h)")          \
  ROW(position, 2, real4, "m; w = inverse mass relative to an interior particle, 0 when pinned")       \
  ROW(position_next, 3, real4, "the other half of position's ping-pong")                               \
  ROW(velocity, 4, real4, "m/s; w unused")                                                             \
  ROW(velocity_next, 5, real4, "the other half of velocity's ping-pong")                               \
  ROW(normal, 6, real4, "unit vertex normal; w unused")                                                \
  ROW(half_velocity, 7, real4, "velocity Verlet: m/s between two kicks; w unused")                     \
  ROW(position_previous, 8, real4, "Verlet: m, one substep ago; w unused")                             \
  ROW(base_position, 9, real4, "Runge-Kutta: m at the step's start; w unused")                         \
  ROW(base_velocity, 10, real4, "Runge-Kutta: m/s at the step's start; w unused")                      \
  ROW(sum_position, 11, real4, "Runge-Kutta: m, the weighted stages so far; w unused")                 \
  ROW(sum_velocity, 12, real4, "Runge-Kutta: m/s, the weighted stages so far; w unused")               \
  ROW(constraints, 13, real4, "XPBD: rest [m], compliance [m/N], damping time [s] of each kind")       \
  ROW(compensation, 14, real4, "f32k: m and m/s that position, then velocity, have too much")          \
  ROW(band_scratch, 15, vec4, "kernel bands: m and m/s of a band's rows between two substeps")         \
  ROW(band_texels, 16, vec4, "band_scratch as the kernel reads it: the same memory")                   \
  ROW(collision, 17, Collision, "self-collision: limits, grid and room (collision.h)")                 \
  ROW(collision_state, 18, uint, "whether the pair lists are stale; counts (collision.h)")             \
  ROW(built_position, 19, real4, "m, when the pair lists were made; w unused")                         \
  ROW(cells, 20, uint, "grid: blocks counted, then ends, then starts of buckets, and total")           \
  ROW(cell_arrivals, 21, uint, "blocks bucket by bucket, as they came")                                \
  ROW(cell_members, 22, uint, "blocks bucket by bucket, ascending")                                    \
  ROW(pair_count, 23, uint, "entries of a particle's list")                                            \
  ROW(pair_places, 24, uint, "lists: entry k of particle p at k * particles + p")                      \
  ROW(touch_weight, 25, uint, "weights of the contacts that a particle is in, added up (collision.h)") \
  ROW(draw_position, 26, vec4, "f64: position rounded to float, as it is drawn")                       \
  ROW(draw_normal, 27, vec4, "f64: normal rounded to float, as it is drawn")                           \
  ROW(queue_heads, 28, uint, "kernel steal: workgroups done, then tiles taken of each queue")          \
  ROW(moved_pins, 29, MovedPin, "particles of pins that move: anchor [m], particle, pin")              \
  ROW(strain_limits, 30, real4, "structural, shear: x = longest [m], y = its square")                  \
  ROW(watch_parts, 31, uint, "fastest particle and energy of each piece of the cloth (watch.h)")       \
  ROW(watch_state, 32, uint, "whether the state is sound, and what was found (watch.h)")               \
  ROW(kept_position, 33, real4, "m, of the last state that was sound")                                 \
  ROW(kept_velocity, 34, real4, "m/s, of the last state that was sound")                               \
  ROW(distance_grids, 35, uint, "meshes: bits of float distances [m], grid by grid, x fastest")        \
  ROW(tethers, 36, Tether, "XPBD: the nearest pinned particle and how far from it a particle may be")  \
  ROW(broken_links, 37, uint, "bits of the links that a particle names (links.h): set once broken")    \
  ROW(torn_mesh, 38, uint, "indices: 6 a cell for its triangles, then 6 a particle for its lines")     \
  ROW(near_position, 39, real4, "m, when contacts were last looked at; w = relative inverse mass")     \
  ROW(near_velocity, 40, real4, "m/s, when contacts were last looked at; w unused")                    \
  ROW(surface_count, 41, uint, "entries of a particle's list of triangles and edges")                  \
  ROW(surface_pairs, 42, uint, "those lists: entry k of particle p at k * particles + p")              \
  ROW(surface_bound, 43, uint, "bits of the farthest a particle may go from near_position [m]")        \
  ROW(surface_sums, 44, uint, "pushes and kicks of surfaces, in whole quanta (collision.h)")           \
  ROW(carrier, 45, real4, "motion that all of the cloth shares: three rows (collision.h)")             \
  ROW(reach_groups, 46, uint, "workgroups of passes that run only where there is need (reach.h)")      \
  ROW(patches, 47, real4, "boxes of 2 x 2 particles: low corner [m], 1 where spread; high, folds")     \
  ROW(patch_listed, 48, uint, "which of a patch's particles look for others, and where")               \
  ROW(lookers, 49, uint, "places of those particles, as they came")                                    \
  ROW(blocks, 50, real4, "boxes of 4 x 4 particles, which the grid holds: low corner [m]; high")       \
  ROW(spread_state, 51, uint, "whether the cloth stays spread out, nowhere folded (spread.h)")

#endif
