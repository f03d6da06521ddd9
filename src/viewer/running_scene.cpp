// Opening and changing the scene in the window.
#include "viewer/running_scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "model/carry.h"
#include "model/measures.h"
#include "sim/host_drawn.h"
#include "sim/native_simulation.h"

namespace weft {
namespace {

using Milliseconds = std::chrono::duration<double, std::milli>;

/// Whether the start, and so what displacement is counted from, is the same.
bool same_start(const ClothSection& a, const ClothSection& b) {
  return a.width_m == b.width_m && a.height_m == b.height_m && a.resolution == b.resolution &&
         a.orientation == b.orientation && a.center_m == b.center_m && a.imperfection_m == b.imperfection_m;
}

/// A name that is none is said at once; whether the kernel fits is seen scene by scene.
std::string kernel_or_auto(std::string name) {
  if (name.empty()) return "auto";
  if (std::ranges::find(kernel_names(), name) == kernel_names().end())
    throw error(Exit::usage, "kernel is \"{}\"; it must be one of {}", name, fmt::join(kernel_names(), ", "));
  return name;
}

}  // namespace

RunningScene::RunningScene(gpu::Device& device, SceneOverrides overrides, const std::string& which,
                           std::string kernel, ComputeOn compute_on)
    : device_(device),
      overrides_(std::move(overrides)),
      kernel_(kernel_or_auto(std::move(kernel))),
      compute_on_(compute_on),
      pipelines_(std::make_shared<GpuPipelines>(device)),
      pacer_(1.0 / 60.0) {
  open(which);
}

void RunningScene::open(const std::string& which) {
  const LoadedScene loaded = load_scene(find_scene(which), overrides_);
  change_.reset();  // it is of the scene before
  finish_part();
  release();  // before anything can fail: what runs on must not stay held
  const std::vector<HandPin> pins = std::exchange(hand_pins_, {});
  try {
    adopt(loaded.scene, false);
  } catch (...) {
    hand_pins_ = pins;
    throw;
  }
  which_ = which;
  warnings_ = loaded.warnings;
  stand_in_.forget();
}

void RunningScene::reload(bool new_shaders) {
  const LoadedScene loaded = load_scene(find_scene(which_), overrides_);
  settle();
  release();
  const std::shared_ptr<GpuPipelines> before = pipelines_;
  if (new_shaders) pipelines_ = std::make_shared<GpuPipelines>(device_);
  try {
    adopt(loaded.scene, true, new_shaders);
  } catch (...) {
    pipelines_ = before;
    throw;
  }
  warnings_ = loaded.warnings;
  stand_in_.forget();
}

void RunningScene::reset() {
  settle();
  rest();
  release();
  const State start = start_state(model());
  simulation_->write(start);
  const Grid& grid = model().grid;
  for (HandPin& pin : hand_pins_) {
    const auto i = static_cast<std::uint32_t>(std::lround(pin.at.x * (grid.nx - 1)));
    const auto j = static_cast<std::uint32_t>(std::lround(pin.at.y * (grid.ny - 1)));
    pin.place_m = start.position[grid.index(i, pin.cloth * grid.ny + j)];
  }
  begin_again();
}

void RunningScene::apply(const Scene& next) {
  release();
  adopt(next, true);
}

Pace RunningScene::pace() const {
  return {pacer_.speed(), pacer_.real_time_factor(), pacer_.slow_motion(), simulation_->plan().substeps};
}

void RunningScene::keep_pace() {
  if (paused_ || diverged() || hand_.holds()) return;
  if (stand_in_.active() && own_needed_of_ != shown_version_) {  // the bound takes a while: once a change
    Scene own = scene_;
    own.solver = stand_in_.own_solver();
    own_needed_ = substeps_per_frame(build_model(composed(own)), find_solver(own.solver.name));
    own_needed_of_ = shown_version_;
  }
  const std::optional<Scene> next = stand_in_.look(scene_, pace(), model().grid.count(), own_needed_);
  if (!next) return;
  try {
    apply(*next);
  } catch (...) {
    stand_in_.forget();
    stand_in_.allow(false);
    throw;
  }
  pacer_.restart();  // the next reading is of the other solver
}

Scene RunningScene::composed(const Scene& scene) const {
  Scene whole = scene;
  const double cell_m = scene.cloth.width_m / std::max(1.0, scene.cloth.resolution - 1.0);
  // Three quarters of a cell hold a particle wherever the pin lies.
  for (const HandPin& pin : hand_pins_)
    whole.pins.push_back({.at = pin.at, .radius_m = 0.75 * cell_m, .cloth = pin.cloth});
  return whole;
}

/// Everything that can fail comes before the first change.
void RunningScene::adopt(const Scene& next, bool keep_state, bool anew) {
  settle();
  const Clock::time_point start = Clock::now();
  const Model model = build_model(composed(next));
  rest();
  figures_.kept_plan = !anew && keep_state && keeps_start(next) && simulation_->adopt(model);
  if (!figures_.kept_plan) {
    std::optional<State> state;
    if (keep_state) state = carry_state(simulation_->model(), simulation_->read(), model);
    MadeSimulation next_one = made(model);
    if (state) next_one.simulation->write(*state);
    take(std::move(next_one));
  }
  settle_in(next);
  if (!keep_state) begin_again();
  figures_.rebuild_ms = Milliseconds(Clock::now() - start).count();
}

/// Whether the running simulation may be able to take the model of `next` over as it is.
bool RunningScene::keeps_start(const Scene& next) const {
  return simulation_ && same_start(scene_.cloth, next.cloth) && scene_.cloths == next.cloths &&
         simulation_->plan().solver->name == next.solver.name;
}

/// The simulation is that of `next` by now: so is the rest.
void RunningScene::settle_in(const Scene& next) {
  scene_ = next;
  shown_ = simulation_->model();
  shown_.scene.pins = next.pins;
  ++shown_version_;
  if (pacer_.frame_s() != next.solver.frame_s) pacer_.set_frame(next.solver.frame_s);
  drop_frame();  // its end would be another cloth's
  watched_.reset();
}

void RunningScene::begin_change(const Scene& next) {
  settle();
  release();
  change_ = std::make_unique<SceneChange>(next, composed(next));
}

bool RunningScene::follow_change() {
  constexpr std::chrono::milliseconds kPatience{6};  // a small cloth's change is seen in the next picture
  if (retired_ && retired_->read_until <= device_.completed()) retired_.reset();
  const Clock::time_point until = Clock::now() + kPatience;
  while (change_ && change_->done_by(until))
    if (go_on_changing()) return true;
  return false;
}

/// One part is done: what of it the running scene has to do with. Returns whether it was the last.
bool RunningScene::go_on_changing() {
  try {
    change_->finish();
    if (change_->part() == SceneChange::Part::model) {
      rest();
      figures_.kept_plan = keeps_start(change_->next()) && simulation_->adopt(change_->model());
      if (!figures_.kept_plan) {
        change_->make_simulation([this](const Model& model) { return made(model); });
        return false;
      }
    } else if (change_->part() == SceneChange::Part::simulation) {
      rest();
      finish_part();
      change_->carry(simulation_->model(), simulation_->read());
      return false;
    } else {
      retired_ = Retired{std::move(simulation_), device_.submitted()};
      take(change_->take());
    }
  } catch (...) {
    change_.reset();
    throw;
  }
  const std::unique_ptr<SceneChange> done = std::move(change_);
  settle_in(done->next());
  figures_.rebuild_ms = Milliseconds(Clock::now() - done->since()).count();
  return true;
}

void RunningScene::settle() {
  while (change_) go_on_changing();
  finish_part();
}

/// On the device or on the host; for any thread.
MadeSimulation RunningScene::made(const Model& model) const {
  if (compute_on_ == ComputeOn::device) return {made_on_device(model), ""};
  const Solver& solver = find_solver(model.scene.solver.name);
  const std::string& precision = model.scene.solver.precision;
  return {draw_host_simulation(device_, make_native_simulation(model, solver, precision)),
          native_lacks(model, solver, precision)};
}

void RunningScene::take(MadeSimulation next) {
  simulation_ = std::move(next.simulation);
  native_lacks_ = std::move(next.native_lacks);
  on_gpu_ = dynamic_cast<GpuSimulation*>(simulation_.get());
  on_host_ = dynamic_cast<HostDrawnSimulation*>(simulation_.get());
  ++version_;
  figures_.frame_ms = figures_.expected_ms = 0.0;  // another cloth's say nothing of this one
  // Particles that are pinned now and were not before were put in their places, and pull yet.
  next_measure_ = std::max(next_measure_, Clock::now() + std::chrono::milliseconds(250));
}

std::unique_ptr<DrawnSimulation> RunningScene::copy_of(const Model& model,
                                                       const std::shared_ptr<GpuPipelines>& pipelines) const {
  const Solver& solver = find_solver(model.scene.solver.name);
  if (on_gpu_ != nullptr) return GpuSimulation::create(device_, model, solver, {.pipelines = pipelines});
  return draw_host_simulation(device_, make_native_simulation(model, solver, model.scene.solver.precision));
}

study::Bench RunningScene::bench() const {
  if (compute_on_ == ComputeOn::native) return study::Bench::without_device(true);
  return {.device = &device_, .label = device_.info().label(), .pipelines = pipelines_};
}

std::string RunningScene::computed_by() const {
  return on_gpu_ != nullptr ? device_.info().label() : simulation_->device_name();
}

std::unique_ptr<GpuSimulation> RunningScene::made_on_device(const Model& model) const {
  const Solver& solver = find_solver(model.scene.solver.name);
  GpuSimulationOptions options{
      .pipelines = pipelines_, .kernel = kernel_ == "auto" ? "" : kernel_, .trial = KernelTrial::never};
  if (!options.kernel.empty() && solver.on_gpu) {
    const Plan plan = compile_plan(model, solver, model.scene.solver.precision);
    const std::vector<std::string> fitting = fitting_kernel_names(device_, plan);
    if (std::ranges::find(fitting, options.kernel) == fitting.end()) options.kernel = "auto";
  }
  return GpuSimulation::create(device_, model, solver, options);
}

void RunningScene::set_kernel(const std::string& name) {
  if (on_gpu_ == nullptr)
    throw Error(Exit::usage,
                "the kernels are those of a Vulkan device's shaders, and native computes this cloth");
  settle();
  if (name != "auto") named_kernel(device_, simulation_->plan(), name);
  const std::string before = std::exchange(kernel_, kernel_or_auto(name));
  release();
  try {
    adopt(scene_, true, true);
  } catch (...) {
    kernel_ = before;
    throw;
  }
}

void RunningScene::begin_again() {
  drop_frame();
  divergence_text_.clear();
  figures_.measured_at_s = -1.0;
  figures_.frame_ms = figures_.expected_ms = 0.0;
  pacer_.restart();
}

void RunningScene::toggle_pin(std::uint32_t particle, const glm::dvec3& place_m) {
  release();
  const Grid& grid = model().grid;
  const PinSection here = Hand::pin(grid, particle);
  Scene next = scene_;
  const std::vector<HandPin> before = hand_pins_;
  if (model().inverse_mass_at(particle, simulation_->time_s()) > 0.0) {
    hand_pins_.push_back({here.at, place_m, here.cloth});
  } else {
    const auto reaches = [&](const auto& pin, double radius_m) {
      const glm::dvec2 way = (pin.at - here.at) * glm::dvec2(grid.width_m(), grid.height_m());
      return pin.cloth == here.cloth && std::hypot(way.x, way.y) <= radius_m * (1.0 + 1e-6);
    };
    std::erase_if(hand_pins_, [&](const HandPin& pin) { return reaches(pin, 0.75 * grid.spacing_m); });
    std::erase_if(next.pins, [&](const PinSection& pin) { return reaches(pin, pin.radius_m); });
  }
  try {
    adopt(next, true);
  } catch (...) {
    hand_pins_ = before;
    throw;
  }
}

void RunningScene::grab(const State& state, const Pick& pick) {
  const Model before = model();
  rest();
  Scene with_hand = composed(scene_);
  with_hand.pins.push_back(Hand::pin(before.grid, pick.particle));
  const Model held = build_model(with_hand);
  if (!simulation_->adopt(held)) {
    auto with_pin = made(held);
    with_pin.simulation->write(state);
    take(std::move(with_pin));
  }
  drop_frame();
  hand_.grab(before, held, state, pick);
}

void RunningScene::release() {
  if (!hand_.holds()) return;
  hand_.let_go();
  adopt(scene_, true);
}

}  // namespace weft
