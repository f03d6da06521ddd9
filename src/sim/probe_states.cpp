// The states on which a pass is checked.
#include "sim/probe_states.h"

#include <algorithm>
#include <glm/common.hpp>
#include <limits>

#include "model/distance_grid.h"
#include "model/solids.h"
#include "sim/simulation.h"

namespace weft {
namespace {

/// A number in [−1, 1) that depends on nothing but its index (a 64-bit mix, splitmix64 by S. Vigna).
double noise(std::uint64_t index) {
  std::uint64_t z = (index + 1) * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  z ^= z >> 31;
  return static_cast<double>(z >> 11) * 0x1p-52 - 1.0;
}

glm::dvec3 noise3(std::uint64_t index) {
  return {noise(3 * index), noise(3 * index + 1), noise(3 * index + 2)};
}

State shaken(const Model& model, const State& from) {
  constexpr double kSpeed_m_s = 2.0;
  State state = from;
  for (std::size_t p = 0; p < state.position.size(); ++p) {
    state.position[p] += 0.1 * model.grid.spacing_m * noise3(2 * p);
    state.velocity[p] += kSpeed_m_s * noise3(2 * p + 1);
  }
  return state;
}

bool has_collider(const Scene& scene) {
  return scene.floor || !scene.spheres.empty() || !scene.capsules.empty() || !scene.boxes.empty() ||
         !scene.meshes.empty();
}

/// Moves the cloth so that its middle lies in the first sphere, capsule or box, or on the floor when there is
/// none, and sends it inwards.
State in_contact(const Model& model, const State& from) {
  const Scene& scene = model.scene;
  State state = from;
  glm::dvec3 lowest(std::numeric_limits<double>::max()), highest(std::numeric_limits<double>::lowest());
  for (const glm::dvec3& x : state.position) {
    lowest = glm::min(lowest, x);
    highest = glm::max(highest, x);
  }
  glm::dvec3 target = 0.5 * (lowest + highest);
  if (scene.floor) target.y = scene.floor->height_m;
  if (!scene.spheres.empty())
    target = sphere_center_at(scene.spheres[0], 0.0) + glm::dvec3(0.0, 0.9 * scene.spheres[0].radius_m, 0.0);
  else if (const std::vector<Solid> solids = solids_of(scene); !solids.empty())
    target = frame_at(solids[0], 0.0).center_m +
             glm::dvec3(0.0, 0.8 * (solids[0].radius_m + solids[0].half_m.z), 0.0);
  else if (!scene.meshes.empty())
    target = frame_at(scene.meshes[0], 0.0).center_m;
  const glm::dvec3 shift = target - 0.5 * (lowest + highest);
  for (glm::dvec3& x : state.position) x += shift;
  for (glm::dvec3& v : state.velocity) v.y -= 3.0;
  return state;
}

/// Folds the cloth about its middle column onto itself, half a thickness apart and somewhat uneven, with the
/// layers closing: layers that touch.
State folded(const Model& model, const State& from) {
  const Grid& grid = model.grid;
  const double thickness_m = 2.0 * model.half_thickness_m;
  State state = from;
  for (std::uint32_t j = 0; j < grid.rows(); ++j)
    for (std::uint32_t i = grid.nx / 2; i < grid.nx; ++i) {
      const std::uint32_t p = grid.index(i, j), under = grid.index(grid.nx - 1 - i, j);
      state.position[p] =
          from.position[under] + 0.5 * thickness_m * (glm::dvec3(0.2, 1.0, 0.6) + 0.3 * noise3(p));
      state.velocity[p] = from.velocity[under] + glm::dvec3(0.1, -1.0, -0.5);
    }
  return state;
}

/// Some links of every kind broken, here and there.
State partly_torn(const Model& model, const State& from) {
  constexpr double kShare = 0.04;
  State state = from;
  state.broken_links.assign(model.grid.count(), 0);
  for (std::uint32_t p = 0; p < state.broken_links.size(); ++p)
    for (std::uint32_t bit = 0; bit < 4; ++bit)
      if (noise(4 * std::uint64_t{p} + bit) > 1.0 - 2.0 * kShare) state.broken_links[p] |= 1u << bit;
  return state;
}

}  // namespace

std::vector<ProbeState> probe_states(const Model& model, const Solver& solver) {
  std::vector<ProbeState> states;
  states.push_back({"start", start_state(model)});
  const auto reference = make_cpu_simulation(model, solver, "f32");
  for (int frame = 0; frame < 2; ++frame)
    reference->advance(model.scene.solver.frame_s, reference->plan().substeps);
  states.push_back({"2 frames on", reference->read()});
  states.push_back({"shaken", shaken(model, states[0].state)});
  if (has_collider(model.scene)) states.push_back({"in contact", in_contact(model, states[2].state)});
  if (model.scene.self_collision) states.push_back({"folded", folded(model, states[0].state)});
  if (model.scene.tearing) states.push_back({"torn", partly_torn(model, states[2].state)});
  return states;
}

}  // namespace weft
