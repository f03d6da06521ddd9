// Puts cloth, kernel and threads together.
#include "native/engine.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <thread>

#include "core/cores.h"
#include "native/features.h"
#include "passes/integrate.h"
#include "passes/passes.h"

namespace weft::native {
namespace {

/// The most threads that a trial may find best: more than there are cores would only wait for each other.
std::uint32_t threads_most() { return std::min(usable_cores(), wished_threads().value_or(kThreadsMax)); }

ThreadChoice choice_for(const Cloth& cloth, const EngineOptions& options) {
  const auto rows_allow =
      static_cast<std::uint32_t>(std::max<std::size_t>(1, cloth.rows() / kRowsPerBandMin));
  if (options.threads != 0) return ThreadChoice::fixed(std::min(options.threads, rows_allow));
  return ThreadChoice(std::min(threads_most(), rows_allow), cloth.nx() * cloth.rows());
}

bool is_xpbd(const Plan& plan) {
  return std::ranges::any_of(plan.steps, [](const PlanStep& step) { return step.pass == &xpbd_predict; });
}

/// The constants of all passes that the kernels stand for: which effects there are.
Constants effects_of(const Plan& plan) {
  Constants effects;
  for (const PlanStep& step : plan.steps) {
    if (step.block != weft::Block::substep) continue;
    for (const Constant& constant : step.constants) effects.push_back(constant);
  }
  return effects;
}

Cloth cloth_for(const Model& model, const Plan& plan) {
  return Cloth(model, effects_of(plan), is_xpbd(plan) ? kXpbdPad : kColumns,
               sweep_touches_bodies(plan) || sweep_watches_links(plan, model) ||
                   sweep_watches_motion(plan, model) || plan.spreads);
}

}  // namespace

Means means_of(const Pass& pass, const Plan& plan) {
  static constexpr std::array kSwept{&integrate,    &integrate_torn, &velocity_verlet_step,
                                     &xpbd_predict, &xpbd_pins,      &xpbd_spring,
                                     &xpbd_bend,    &xpbd_tethers,   &xpbd_finish};
  if (std::ranges::count(kSwept, &pass) > 0) return Means::sweep;
  if ((&pass == &solid_contact || &pass == &mesh_contact) && sweep_touches_bodies(plan)) return Means::sweep;
  if (SelfCollision::has(pass)) return Means::look;
  return Effects::has(pass) ? Means::effect : Means::mirror;
}

std::string unsupported(const Plan& plan) {
  if (plan.precision != "f32") return "native computes in f32 only";
  // A solver is native's when its forces are: all else on the way runs beside them.
  for (const PlanStep& step : plan.steps)
    if (step.spring_evaluations > 0 && means_of(*step.pass, plan) != Means::sweep)
      return fmt::format("native has no vector code for the pass {}", step.pass->name);
  return {};
}

Engine::Engine(const Model& model, const Plan& plan, const EngineOptions& options)
    : cloth_(cloth_for(model, plan)),
      kernels_(find_kernels(options.vector)),
      choice_(choice_for(cloth_, options)),
      speeds_(options.speeds),
      allows_spread_frames_(options.spread_frames) {
  furnish(model, plan);
}

void Engine::adopt(const Model& model, const Plan& plan) {
  bands_.clear();
  xpbd_.reset();
  effects_.reset();
  self_collision_.reset();
  cloth_ = cloth_for(model, plan);
  furnish(model, plan);
}

void Engine::furnish(const Model& model, const Plan& plan) {
  links_.reset();
  if (sweep_watches_links(plan, model)) links_ = std::make_unique<LinkWatch>(cloth_, kernels_, model);
  body_touch_.reset();
  if (sweep_touches_bodies(plan)) body_touch_ = std::make_unique<BodyTouch>(model, cloth_.sheet().stride);
  effects_ = std::make_unique<Effects>(cloth_, kernels_, model, body_touch_ == nullptr);
  if (model.scene.self_collision)
    self_collision_ =
        std::make_unique<SelfCollision>(cloth_, kernels_, model, sweep_watches_motion(plan, model));
  spread_.reset();
  if (allows_spread_frames_ && plan.spreads)
    spread_ = std::make_unique<SpreadFrames>(cloth_, kernels_, plan, model);
  if (is_xpbd(plan)) xpbd_ = std::make_unique<Xpbd>(cloth_, kernels_, model, plan, body_touch_.get());
  const auto predicts = [](const PlanStep& step) { return step.pass == &velocity_verlet_step; };
  if (std::ranges::any_of(plan.steps, predicts))
    half_velocity_ = make_floats(cloth_.rows() * 3 * cloth_.sheet().stride);
}

std::uint64_t Engine::bytes() const {
  std::uint64_t bytes = cloth_.bytes() + effects_->bytes();
  if (xpbd_) bytes += xpbd_->bytes();
  if (self_collision_) bytes += self_collision_->bytes();
  if (half_velocity_) bytes += cloth_.rows() * 3 * cloth_.sheet().stride * sizeof(float);
  return bytes;
}

Crew& Engine::crew(std::uint32_t count) {
  if (crew_ == nullptr || crew_->size() < count) crew_ = std::make_unique<Crew>(count - 1);
  return *crew_;
}

Bands& Engine::bands(std::uint32_t count) {
  auto& made = bands_[count];
  if (made == nullptr)
    made = std::make_unique<Bands>(cloth_, kernels_, speeds_, count, half_velocity_.get(), body_touch_.get());
  return *made;
}

/// Whom sweeps have to tell; null: nobody.
LeapWatch* Engine::watch() {
  if (links_) return links_.get();
  return self_collision_ ? self_collision_->watch() : nullptr;
}

template <class Act>
void Engine::share_rows(const Act& act) {
  const std::uint32_t threads = choice_.best();
  crew(threads).run(threads, [&](std::uint32_t own) {
    act(own * cloth_.rows() / threads, (own + 1) * cloth_.rows() / threads);
  });
}

void Engine::sweep(const KickTable& table, std::uint32_t first, std::uint32_t count, float* kick2) {
  using Clock = std::chrono::steady_clock;
  std::span<const Kick> kicks = table.kicks().subspan(first, count);
  while (!kicks.empty()) {
    const Turn turn = choice_.next(static_cast<std::uint32_t>(kicks.size()));
    Crew& together = crew(turn.threads);
    effects_->begin_drift(together, turn.threads);
    const auto began = Clock::now();
    if (xpbd_)
      xpbd_->sweep(together, turn.threads, kicks.first(turn.substeps));
    else
      bands(turn.threads)
          .sweep(together, kicks.first(turn.substeps), kick2 == nullptr ? watch() : nullptr, kick2);
    choice_.report(turn, std::chrono::duration<double>(Clock::now() - began).count());
    kicks = kicks.subspan(turn.substeps);
  }
}

std::uint32_t Engine::sweep_ahead(const KickTable& table, std::uint32_t first, std::uint32_t most) {
  constexpr std::uint32_t kLeast = 4, kMost = 64;  // what is kept costs as much as half a substep
  LeapWatch* const watch = this->watch();
  const std::uint32_t count = watch != nullptr ? std::min({most, watch->quiet_substeps(), kMost}) : 0;
  if (count < kLeast) return 0;
  cloth_.make_keep();
  share_rows([&](std::size_t begin, std::size_t end) { cloth_.keep(begin, end); });
  sweep(table, first, count);
  if (!watch->has_leapt()) {
    watch->tell_ahead(count);
    return count;
  }
  watch->take_back(count);
  share_rows([&](std::size_t begin, std::size_t end) { cloth_.take_back(begin, end); });
  return 0;
}

bool Engine::begin_spread_frame(HostBuffers<float>& buffers) {
  if (!spread_ || !spread_->begin_frame(buffers, crew(choice_.best()), choice_.best())) return false;
  cloth_.make_keep();
  share_rows([&](std::size_t begin, std::size_t end) { cloth_.keep(begin, end); });
  return true;
}

bool Engine::sweep_spread(const KickTable& table, std::uint32_t first, std::uint32_t count) {
  for (std::uint32_t at = first, end = first + count; at < end;) {
    const double drift_s = table.kicks()[at].drift;
    const std::uint32_t substeps = spread_->substeps(drift_s, end - at);
    float kick2 = 0.0f;
    if (substeps == 0) return false;
    sweep(table, at, substeps, &kick2);
    if (!spread_->stayed_spread(drift_s, substeps, kick2, crew(choice_.best()), choice_.best())) return false;
    at += substeps;
  }
  return true;
}

void Engine::take_back_spread_frame(HostBuffers<float>& buffers) {
  spread_->take_back_frame(buffers);
  share_rows([&](std::size_t begin, std::size_t end) { cloth_.take_back(begin, end); });
}

void Engine::load(const HostBuffers<float>& buffers) {
  if (links_) links_->forget();
  if (self_collision_) self_collision_->forget_motion();
  if (cloth_.take_changes(buffers) && xpbd_) xpbd_->take_masses();
  share_rows([&](std::size_t first, std::size_t last) { cloth_.load(buffers, first, last); });
}

void Engine::run(const PlanStep& step, const Kick& kick) {
  if (effects_->run(step, kick, crew(choice_.best()), choice_.best()) && xpbd_) xpbd_->take_masses();
}

bool Engine::look(const Pass& pass, const MirrorContext& context, HostBuffers<float>& buffers) {
  return self_collision_->run(pass, context, buffers, crew(choice_.best()), choice_.best());
}

bool Engine::make_empty_lists(HostBuffers<float>& buffers, const std::function<void()>& need_positions) {
  return self_collision_->make_empty_lists(buffers, crew(choice_.best()), choice_.best(), need_positions);
}

bool Engine::links_are_near(const Kick& kick) {
  return !links_ || links_->is_near(kick, crew(choice_.best()), choice_.best());
}

RowThreads& Engine::threads_for_mirrors() { return crew_rows_.emplace(crew(choice_.best()), choice_.best()); }

void Engine::write_surface(const SurfaceTarget& target) {
  bands(choice_.best())
      .surface(crew(choice_.best()),
               {.position = target.position, .velocity = target.velocity, .normal = target.normal});
}

}  // namespace weft::native
