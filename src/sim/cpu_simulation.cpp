// The plan interpreted by the passes' CPU mirrors: the reference that the GPU and native are held to.
#include "sim/cpu_simulation.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <utility>

#include "core/error.h"
#include "passes/passes.h"
#include "passes/tables.h"
#include "passes/tearing.h"
#include "plan/buffers.h"

namespace weft {
namespace {

template <class T>
struct Precision;

template <>
struct Precision<float> {
  static auto mirror(const Pass& pass) { return pass.mirror_f32; }
};

template <>
struct Precision<double> {
  static auto mirror(const Pass& pass) { return pass.mirror_f64; }
};

/// What a step after the last row sees when there is no closing one.
constexpr KickDrift kNoRow;

}  // namespace

template <class T>
CpuSimulation<T>::CpuSimulation(const Model& model, const Solver& solver, const std::string& precision)
    : model_(model),
      plan_(compile_plan(model_, solver, precision)),
      budget_(model_, start_state(model_), plan_.in_double()),
      step_ms_(plan_.steps.size(), 0.0),
      finished_ms_(plan_.steps.size(), 0.0) {
  size_buffers(plan_, model_, buffers_);
}

template <class T>
State CpuSimulation<T>::read() {
  fetch_state();
  return store_state(buffers_, time_s_);
}

template <class T>
void CpuSimulation<T>::write(const State& state) {
  if (state.position.size() != model_.grid.count() || state.velocity.size() != model_.grid.count())
    throw error(Exit::internal, "a state of {} particles does not fit a cloth of {}", state.position.size(),
                model_.grid.count());
  under_way_ = false;
  load_state(model_, state, buffers_);
  if (model_.scene.self_collision) buffers_.words_of(BufferId::collision_state)[shared::kListsArmed] = 0;
  buffers_written();
  time_s_ = state.time_s;
  budget_ = SpeedBudget(model_, state, plan_.in_double());
  log_.begin(time_s_);
  buffers_.words_of(BufferId::watch_state).assign(shared::kWatchStateWords, 0);
  for (const PlanStep& step : plan_.steps)
    if (watches(*step.pass)) run_step(step, 0);
  log_.look(buffers_.words_of(BufferId::watch_state));
}

template <class T>
FrameStats CpuSimulation<T>::advance(double frame_s, std::uint32_t substeps) {
  begin_frame(frame_s, substeps);
  while (continue_frame(HUGE_VAL)) {
  }
  return frame_.stats;
}

template <class T>
void CpuSimulation<T>::begin_frame(double frame_s, std::uint32_t substeps) {
  frame_ = {.rows = plan_.solver->schedule(time_s_, frame_s, substeps),
            .substeps = substeps,
            .done = 0,
            .start_s = time_s_,
            .length_s = frame_s,
            .stats = {.substeps = substeps, .dispatches = 0, .spring_evaluations = 0}};
  budget_.elapse(model_.scene, frame_s, substeps, std::exchange(hand_m_s_, 0.0));
  step_ms_.assign(plan_.steps.size(), 0.0);
  under_way_ = true;
}

template <class T>
bool CpuSimulation<T>::continue_frame(double wall_s) {
  if (!under_way_) return false;
  if (frame_.done == 0) run_frame_start();
  const double fits = substep_s_ > 0.0 ? wall_s / substep_s_ : std::isinf(wall_s) ? HUGE_VAL : 1.0;
  const auto count =
      static_cast<std::uint32_t>(std::clamp(fits, 1.0, static_cast<double>(frame_.substeps - frame_.done)));
  const Clock::time_point began = Clock::now();
  run_substeps(frame_.done, count);
  substep_s_ = std::chrono::duration<double>(Clock::now() - began).count() / count;
  frame_.done += count;
  if (frame_.done == frame_.substeps) {
    end_frame();
    return false;
  }
  time_s_ = frame_.start_s + frame_.length_s * frame_.done / frame_.substeps;
  return true;
}

template <class T>
void CpuSimulation<T>::end_frame() {
  time_s_ = frame_end_s(frame_.start_s, frame_.length_s);
  log_.end_frame(time_s_, frame_.length_s, frame_.substeps);
  run_frame_end();
  log_.look(buffers_.words_of(BufferId::watch_state));
  finished_ms_ = step_ms_;
  under_way_ = false;
}

template <class T>
std::optional<State> CpuSimulation<T>::last_good() {
  if (!log_.sound_time_s()) return std::nullopt;
  HostBuffers<T> kept;
  kept[BufferId::position] = buffers_[BufferId::kept_position];
  kept[BufferId::velocity] = buffers_[BufferId::kept_velocity];
  kept.words_of(BufferId::broken_links) = buffers_.words_of(BufferId::broken_links);  // torn since is torn
  return store_state(kept, *log_.sound_time_s());
}

template <class T>
std::optional<SelfCollisionReport> CpuSimulation<T>::self_collision() {
  if (!model_.scene.self_collision) return std::nullopt;
  return report_of(buffers_.words_of(BufferId::collision_state));
}

template <class T>
std::uint64_t CpuSimulation<T>::bytes_allocated() const {
  std::uint64_t bytes = 0;
  for (const auto& buffer : buffers_.vec4) bytes += buffer.size() * sizeof(buffer[0]);
  for (const auto& buffer : buffers_.words) bytes += buffer.size() * sizeof(buffer[0]);
  return bytes;
}

template <class T>
void CpuSimulation<T>::write_drawn(const native::SurfaceTarget& target) {
  fetch_state();
  HostBuffers<float> drawn;
  const auto& position = buffers_[BufferId::position];
  drawn[BufferId::position].assign(position.begin(), position.end());
  normals.mirror_f32({model_, {}, kNoRow}, drawn);
  const std::size_t bytes = position.size() * sizeof(glm::vec4);
  std::memcpy(target.position, drawn[BufferId::position].data(), bytes);
  std::memcpy(target.normal, drawn[BufferId::normal].data(), bytes);
  if (!model_.scene.tearing) return;
  drawn.words_of(BufferId::broken_links) = buffers_.words_of(BufferId::broken_links);
  write_torn_surface(model_, drawn, target);
}

void write_torn_surface(const Model& model, HostBuffers<float>& buffers,
                        const native::SurfaceTarget& target) {
  normals_torn.mirror_f32({model, {}, kNoRow}, buffers);
  const auto& normal = buffers[BufferId::normal];
  std::memcpy(target.normal, normal.data(), normal.size() * sizeof(glm::vec4));
  if (target.torn_mesh == nullptr) return;
  auto& mesh = buffers.words_of(BufferId::torn_mesh);
  mesh.resize(torn_mesh_words(model.grid));
  torn_mesh.mirror_f32({model, {}, kNoRow}, buffers);
  std::memcpy(target.torn_mesh, mesh.data(), mesh.size() * sizeof(std::uint32_t));
}

template <class T>
bool CpuSimulation<T>::adopt(const Model& model) {
  Plan next = compile_plan(model, *plan_.solver, model.scene.solver.precision);
  if (!same_commands(next, plan_)) return false;
  const bool anew = gives_by_place(model_, model);
  const State state = read();
  under_way_ = false;
  budget_.adopt(model_, model);
  model_ = model;
  plan_ = std::move(next);
  model_changed();
  if (anew)
    write(state);
  else
    buffers_written();
  return true;
}

template <class T>
void CpuSimulation<T>::place(std::span<const PlacedParticle> particles) {
  require_pinned(model_, particles);
  fetch_state();
  for (const PlacedParticle& placed : particles) {
    hand_m_s_ = std::max(hand_m_s_, static_cast<double>(glm::length(placed.velocity_m_s)));
    buffers_[BufferId::position][placed.particle] = glm::vec<4, T>(glm::vec<3, T>(placed.position_m), T(0));
    buffers_[BufferId::velocity][placed.particle] = glm::vec<4, T>(glm::vec<3, T>(placed.velocity_m_s), T(0));
  }
  buffers_written();
}

template <class T>
void CpuSimulation<T>::run_substeps(std::uint32_t first, std::uint32_t count) {
  for (std::uint32_t k = first; k < first + count; ++k) run_block(Block::substep, k);
}

template <class T>
void CpuSimulation<T>::run_block(Block block, std::uint32_t substep) {
  for (const PlanStep& step : plan_.steps)
    if (step.block == block && (block != Block::substep || substep % step.interval == 0))
      run_step(step, substep);
}

template <class T>
MirrorContext CpuSimulation<T>::context_of(const PlanStep& step, std::uint32_t substep) const {
  const std::uint32_t row = plan_.table_row(step, substep);
  const KickDrift& schedule = row < frame_.rows.size() ? frame_.rows[row] : kNoRow;
  return {model_, step.constants, schedule, row, step.item, budget_.allowed_m_s()};
}

template <class T>
void CpuSimulation<T>::run_step(const PlanStep& step, std::uint32_t substep) {
  const Clock::time_point began = Clock::now();
  Precision<T>::mirror (*step.pass)(context_of(step, substep), buffers_);
  if (step.pass->swaps_state) {
    std::swap(buffers_[BufferId::position], buffers_[BufferId::position_next]);
    std::swap(buffers_[BufferId::velocity], buffers_[BufferId::velocity_next]);
  }
  count(step, 1, ms_since(began));
}

template <class T>
void CpuSimulation<T>::count(const PlanStep& step, std::uint32_t times, double ms) {
  frame_.stats.dispatches += times;
  frame_.stats.spring_evaluations += times * step.spring_evaluations;
  step_ms_[static_cast<std::size_t>(&step - plan_.steps.data())] += ms;
}

template class CpuSimulation<float>;
template class CpuSimulation<double>;

namespace {

template <class T>
std::unique_ptr<HostSimulation> reference_of(const Model& model, const Solver& solver,
                                             const std::string& precision) {
  auto simulation = std::make_unique<CpuSimulation<T>>(model, solver, precision);
  simulation->write(start_state(model));
  return simulation;
}

}  // namespace

std::unique_ptr<HostSimulation> make_host_reference(const Model& model, const Solver& solver,
                                                    const std::string& precision) {
  if (precision == "f64") return reference_of<double>(model, solver, precision);
  return reference_of<float>(model, solver, precision);
}

std::unique_ptr<Simulation> make_cpu_simulation(const Model& model, const Solver& solver,
                                                const std::string& precision) {
  return make_host_reference(model, solver, precision);
}

}  // namespace weft
