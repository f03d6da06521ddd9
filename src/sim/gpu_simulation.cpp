// The plan on a Vulkan device: each frame writes its slot's table, submits the recorded chunks, and returns;
// the slot's turn comes again when the device is done with it.
#include "sim/gpu_simulation.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <glm/geometric.hpp>
#include <optional>
#include <utility>

#include "core/error.h"
#include "model/speed_budget.h"
#include "passes/collision.h"
#include "passes/passes.h"
#include "passes/tables.h"
#include "sim/device_data.h"
#include "sim/frame_commands.h"
#include "sim/frame_log.h"
#include "sim/gpu_spread_frames.h"
#include "sim/perturb.h"
#include "sim/submitted_frames.h"

namespace weft {
namespace {

const Solver& require_gpu(const Solver& solver) {
  if (!solver.on_gpu)
    throw error(Exit::usage,
                "solver.name is \"{}\"; it has no GPU passes and runs on the CPU reference only "
                "(--device cpu, or a solver such as leapfrog)",
                solver.name);
  return solver;
}

class VulkanSimulation final : public GpuSimulation {
 public:
  VulkanSimulation(gpu::Device& device, const Model& model, const Solver& solver,
                   const GpuSimulationOptions& options)
      : device_(device),
        model_(model),
        plan_(compile_plan(model_, require_gpu(solver), model_.scene.solver.precision)),
        perturbation_(options.perturb, plan_),
        program_plan_(perturbed(plan_, perturbation_)),
        pipelines_(options.pipelines ? options.pipelines : std::make_shared<GpuPipelines>(device)),
        choice_(choose_kernel(device, model_, program_plan_, pipelines_, options.kernel, {}, options.trial)),
        buffers_(device, model_, plan_, choice_.kernel),
        program_(device, program_plan_, buffers_, pipelines_, choice_.kernel),
        commands_(device, plan_, program_),
        submitted_(device, options.dispatches_per_submit),
        budget_(model_, start_state(model_), plan_.in_double()),
        free_mass_ratio_(free_mass_ratio(model_)) {
    write_blocks(buffers_, model_, plan_, perturbation_);
    write_groups(buffers_, model_);
    furnish();
    write(start_state(model_));
  }
  ~VulkanSimulation() override {
    try {
      device_.wait(device_.submitted());  // pictures of it, too
    } catch (...) {                       // a lost device has nothing left to wait for
    }
  }
  VulkanSimulation(const VulkanSimulation&) = delete;
  VulkanSimulation& operator=(const VulkanSimulation&) = delete;

  const Model& model() const override { return model_; }
  const Plan& plan() const override { return plan_; }
  std::string device_name() const override { return device_.info().name; }
  double time_s() const override { return time_s_; }
  std::uint64_t bytes_allocated() const override { return buffers_.bytes(); }
  const KernelChoice& kernel() const override { return choice_; }
  std::uint64_t dispatches_expected(std::uint32_t substeps) const override {
    return dispatches_with(choice_.kernel, plan_, substeps);
  }
  std::uint64_t bytes_expected() const override {
    return plan_.bytes() + scratch_bytes(choice_.kernel, plan_);
  }
  std::optional<SelfCollisionReport> self_collision() override;
  std::optional<Divergence> divergence() const override { return log_.divergence(); }
  std::optional<State> last_good() override;
  std::uint32_t submit_count() const override { return submitted_.submit_count(); }
  std::vector<double> step_ms() const override { return submitted_.step_ms(); }
  DrawBuffers draw_buffers() const override {
    const auto handle = [&](BufferId id) {
      return buffers_.has(id) ? buffers_.at(id).handle() : VK_NULL_HANDLE;
    };
    if (buffers_.has(BufferId::draw_position))
      return {handle(BufferId::draw_position), handle(BufferId::draw_normal), handle(BufferId::torn_mesh)};
    return {handle(at_parity(BufferId::position, parity_)), handle(BufferId::normal),
            handle(BufferId::torn_mesh)};
  }
  void wait() override {
    submitted_.finish_all();
    look();
  }

  FrameStats advance(double frame_s, std::uint32_t substeps) override;
  void begin_frame(double frame_s, std::uint32_t substeps) override;
  bool continue_frame() override;
  bool await_part(double wait_s) override;
  double part_ms() const override { return submitted_.part_ms(); }
  void refresh_normals() override;
  State read() override;
  void write(const State&) override;
  bool adopt(const Model&) override;
  void place(std::span<const PlacedParticle>) override;

 private:
  struct Frame {  // the one being submitted
    std::uint32_t slot = 0, substeps = 0, done = 0;
    double start_s = 0, length_s = 0;
    std::optional<DispatchOrder> order;           // absent between frames
    GpuSpreadFrames::Commands* spread = nullptr;  // it is computed so; null: with all passes
    bool proven = false;                          // that it may be
    FrameStats stats{};
  };
  static Plan perturbed(Plan plan, const Perturbation& perturbation) {
    perturbation.apply(plan);
    return plan;
  }
  /// What of the parameters changes with time.
  void write_allowance(std::uint32_t slot);
  /// Takes in the device's verdict as it is by now.
  void look() { log_.look(read_words<shared::kWatchStateWords>(buffers_, BufferId::watch_state)); }
  enum class Watched { yes, no };
  /// Runs what follows a frame's last kick on the state as it is; with the watch or without.
  void run_frame_end(Watched watched);
  void forget_lists();
  void furnish();
  void compute_whole();
  bool proves_spread();
  void settle();
  void charge_spread();
  void end_frame();

  gpu::Device& device_;
  Model model_;
  Plan plan_;
  Perturbation perturbation_;
  Plan program_plan_;
  std::shared_ptr<GpuPipelines> pipelines_;
  KernelChoice choice_;
  GpuBuffers buffers_;
  GpuProgram program_;
  FrameCommands commands_;
  SubmittedFrames submitted_;
  std::unique_ptr<GpuSpreadFrames> spread_;  // null where the plan has no such frames
  Frame frame_;
  FrameLog log_;
  SpeedBudget budget_;
  double free_mass_ratio_;
  bool kept_is_now_ = false;  // what keep_sound kept is the state
  bool last_spread_ = false;  // the latest frame had none of self-collision's passes
  double hand_m_s_ = 0.0;     // speed of the fastest particle placed since the latest frame began
  Parity parity_ = 0;
  std::uint64_t frames_ = 0;
  std::uint32_t spread_frames_ = 0;
  double time_s_ = 0;
};

std::optional<SelfCollisionReport> VulkanSimulation::self_collision() {
  if (!model_.scene.self_collision) return std::nullopt;
  wait();
  auto words = read_words<shared::kCollisionStateWords>(buffers_, BufferId::collision_state);
  if (last_spread_) words[shared::kSmallestGap] = shared::kInfinity;
  SelfCollisionReport report = report_of(words);
  report.spread_frames = spread_frames_;
  return report;
}

void VulkanSimulation::write_allowance(std::uint32_t slot) {
  write_energy_share(buffers_, slot, plan_, energy_share_s2_m2(free_mass_ratio_, budget_.allowed_m_s()));
}

FrameStats VulkanSimulation::advance(double frame_s, std::uint32_t substeps) {
  begin_frame(frame_s, substeps);
  while (continue_frame()) {
  }
  return frame_.stats;
}

void VulkanSimulation::begin_frame(double frame_s, std::uint32_t substeps) {
  if (commands_.crowded()) {
    wait();
    commands_.clear();
  }
  const std::uint32_t slot_index = static_cast<std::uint32_t>(frames_++ % kFrameSlots);
  wait();  // for the verdict on all that was computed; not for pictures of it
  submitted_.begin_frame(slot_index, plan_);
  write_table(buffers_, slot_index, model_, plan_, plan_.solver->schedule(time_s_, frame_s, substeps),
              perturbation_);
  budget_.elapse(model_.scene, frame_s, substeps, std::exchange(hand_m_s_, 0.0));
  write_allowance(slot_index);
  frame_ = {.slot = slot_index,
            .substeps = substeps,
            .start_s = time_s_,
            .length_s = frame_s,
            .stats = {.substeps = substeps}};
  if (spread_ && kept_is_now_ && !log_.divergence())
    frame_.spread = spread_->begin_frame(parity_, slot_index, frame_s / substeps, substeps);
  charge_spread();
  kept_is_now_ = false;
  if (frame_.spread == nullptr) return compute_whole();
  frame_.order = DispatchOrder(frame_.spread->plan, substeps);
  submitted_.count_as(slot_index, &frame_.spread->step_of);
}

/// The frame from its start with all passes.
void VulkanSimulation::compute_whole() {
  frame_.spread = nullptr;
  frame_.done = 0;
  frame_.order = DispatchOrder(plan_, frame_.substeps, choice_.kernel.substeps);
  submitted_.count_as(frame_.slot, nullptr);
  if (spread_) spread_->forget();
  if (std::exchange(last_spread_, false)) forget_lists();
}

/// What was done outside the frame's commands counts as the time of pair_check, whose work it does.
void VulkanSimulation::charge_spread() {
  if (!spread_) return;
  const double ms = spread_->take_host_ms();
  for (std::size_t step = 0; step < plan_.steps.size(); ++step)
    if (plan_.steps[step].pass == &pair_check && plan_.steps[step].block == Block::frame_end)
      submitted_.add(frame_.slot, step, ms);
}

/// Once all is computed that proves it; what was is taken back where it does not.
bool VulkanSimulation::proves_spread() {
  submitted_.finish(frame_.slot);
  frame_.proven = spread_->stayed_spread();
  if (frame_.proven) return true;
  spread_->take_back(parity_);
  charge_spread();
  compute_whole();
  return false;
}

bool VulkanSimulation::continue_frame() {
  if (!frame_.order) return false;
  const bool unproven = frame_.spread != nullptr && !frame_.proven;
  if (unproven && frame_.done == GpuSpreadFrames::proven_before(*frame_.order) && !proves_spread())
    return true;
  const SubmitPacer& pacer = submitted_.pacer(frame_.slot);
  if (pacer.learning()) submitted_.finish(frame_.slot);
  const DispatchOrder& order = *frame_.order;
  const bool waits = frame_.spread != nullptr && !frame_.proven;
  const std::uint32_t end = waits ? GpuSpreadFrames::proven_before(order) : order.count();
  const std::uint32_t count = std::min(pacer.chunk(), end - frame_.done);
  const std::uint32_t n = order.independent_of_substeps(frame_.done, count) ? 0 : frame_.substeps;
  FrameCommands& commands = frame_.spread != nullptr ? frame_.spread->recorded : commands_;
  FrameCommands::Chunk& chunk = commands.chunk({frame_.slot, parity_, frame_.done, count, n}, order);
  submitted_.submit(frame_.slot, chunk);
  parity_ = chunk.parity_after;
  frame_.stats.dispatches += chunk.dispatches;
  frame_.done += count;
  if (frame_.done < order.count()) {
    time_s_ = frame_.start_s + frame_.length_s * order[frame_.done].substep / frame_.substeps;
    return true;
  }
  end_frame();
  return false;
}

bool VulkanSimulation::await_part(double wait_s) {
  if (!submitted_.await(wait_s)) return false;
  wait();
  return true;
}

void VulkanSimulation::end_frame() {
  for (std::uint32_t place = 0; place < frame_.order->count(); ++place) {
    const DispatchOrder::Dispatch dispatch = (*frame_.order)[place];
    const Plan& plan = frame_.spread != nullptr ? frame_.spread->plan : plan_;
    frame_.stats.spring_evaluations += dispatch.count * plan.steps[dispatch.step].spring_evaluations;
  }
  last_spread_ = frame_.spread != nullptr;
  spread_frames_ += last_spread_ ? 1 : 0;
  kept_is_now_ = true;
  time_s_ = frame_end_s(frame_.start_s, frame_.length_s);
  log_.end_frame(time_s_, frame_.length_s, frame_.substeps);
  frame_.order.reset();
}

/// What is not proven yet of a frame that is under way is computed with all passes: somebody asks for the
/// state, or changes it.
void VulkanSimulation::settle() {
  if (!frame_.order || frame_.spread == nullptr || frame_.proven) return;
  submitted_.finish(frame_.slot);
  if (frame_.done > 0) spread_->take_back(parity_);
  const double reached_s = std::exchange(time_s_, frame_.start_s);
  compute_whole();
  while (time_s_ < reached_s && continue_frame()) {
  }
}

State VulkanSimulation::read() {
  settle();
  wait();
  return read_state(buffers_, parity_, model_, plan_, time_s_);
}

/// What self-collision knows of where particles were says nothing of a state from outside.
void VulkanSimulation::forget_lists() {
  if (!model_.scene.self_collision) return;
  const std::uint32_t no = 0;
  buffers_.at(BufferId::collision_state)
      .write_unused(std::as_bytes(std::span(&no, 1)), shared::kListsArmed * sizeof no);
}

void VulkanSimulation::write(const State& state) {
  wait();
  frame_.order.reset();
  write_state(buffers_, parity_, model_, plan_, state);
  time_s_ = state.time_s;
  budget_ = SpeedBudget(model_, state, plan_.in_double());
  write_allowance(0);
  forget_lists();
  if (spread_) spread_->forget();
  last_spread_ = false;
  kept_is_now_ = true;
  log_.begin(time_s_);
  const std::vector<std::byte> sound(shared::kWatchStateWords * sizeof(std::uint32_t));
  buffers_.at(BufferId::watch_state).write_unused(sound);
  run_frame_end(Watched::yes);
  look();
}

/// What is drawn before the first frame, in the middle of one or after a write needs the normals of that
/// state.
void VulkanSimulation::refresh_normals() {
  wait();
  run_frame_end(Watched::no);
}

void VulkanSimulation::run_frame_end(Watched watched) {
  device_.run_once([&](VkCommandBuffer commands) {
    gpu::Recorder recorder(device_, commands);
    for (std::size_t step = 0; step < plan_.steps.size(); ++step) {
      const Pass& pass = *plan_.steps[step].pass;
      const bool moves = program_.flips(step) || pass.tells_reach || &pass == &carry || &pass == &pair_check;
      if (plan_.steps[step].block != Block::frame_end || moves) continue;
      if (watched == Watched::yes || !watches(pass)) program_.dispatch(recorder, step, parity_, 0, 0);
    }
    recorder.finish();
  });
}

std::optional<State> VulkanSimulation::last_good() {
  wait();
  if (!log_.sound_time_s()) return std::nullopt;
  return read_kept(buffers_, model_, plan_, *log_.sound_time_s());
}

bool VulkanSimulation::adopt(const Model& model) {
  Plan next = compile_plan(model, *plan_.solver, model.scene.solver.precision);
  if (!same_commands(next, plan_)) return false;
  settle();
  const bool anew = gives_by_place(model_, model);
  State state;
  if (anew) state = read();
  wait();
  frame_.order.reset();
  budget_.adopt(model_, model);
  model_ = model;
  free_mass_ratio_ = free_mass_ratio(model_);
  plan_ = std::move(next);
  write_blocks(buffers_, model_, plan_, perturbation_);
  furnish();
  if (anew) write(state);
  return true;
}

/// What follows from the model alone.
void VulkanSimulation::furnish() {
  spread_.reset();
  if (plan_.spreads)
    spread_ = std::make_unique<GpuSpreadFrames>(device_, model_, program_plan_, buffers_, pipelines_,
                                                choice_.kernel);
}

void VulkanSimulation::place(std::span<const PlacedParticle> particles) {
  settle();
  wait();
  kept_is_now_ = false;
  for (const PlacedParticle& placed : particles)
    hand_m_s_ = std::max(hand_m_s_, static_cast<double>(glm::length(placed.velocity_m_s)));
  write_placed(buffers_, parity_, model_, plan_, particles);
}

}  // namespace

std::unique_ptr<GpuSimulation> GpuSimulation::create(gpu::Device& device, const Model& model,
                                                     const Solver& solver,
                                                     const GpuSimulationOptions& options) {
  return std::make_unique<VulkanSimulation>(device, model, solver, options);
}

}  // namespace weft
