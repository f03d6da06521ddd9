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
#include "sim/perturb.h"
#include "sim/submit_pacer.h"

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
        pacer_(options.dispatches_per_submit),
        budget_(model_, start_state(model_), plan_.in_double()),
        free_mass_ratio_(free_mass_ratio(model_)) {
    write_blocks(buffers_, model_, plan_, perturbation_);
    write_groups(buffers_, model_);
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
  std::uint32_t submit_count() const override { return submits_; }
  std::vector<double> step_ms() const override { return step_ms_; }
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
    for (Slot& slot : slots_) finish(slot);
    look();
  }

  FrameStats advance(double frame_s, std::uint32_t substeps) override;
  void begin_frame(double frame_s, std::uint32_t substeps) override;
  bool continue_frame() override;
  bool await_part(double wait_s) override;
  double part_ms() const override { return part_ms_; }
  void refresh_normals() override;
  State read() override;
  void write(const State&) override;
  bool adopt(const Model&) override;
  void place(std::span<const PlacedParticle>) override;

 private:
  using Clock = std::chrono::steady_clock;
  struct Slot {
    std::vector<FrameCommands::Chunk*> chunks;  // of the frame that runs in it
    std::uint64_t last_submit = 0;
    Clock::time_point start;
    StepTimes times;  // of the frame so far
  };
  struct Frame {  // the one being submitted
    std::uint32_t slot = 0, substeps = 0, done = 0;
    double start_s = 0, length_s = 0;
    std::optional<DispatchOrder> order;  // absent between frames
    FrameStats stats;
  };
  static Plan perturbed(Plan plan, const Perturbation& perturbation) {
    perturbation.apply(plan);
    return plan;
  }
  /// What of the parameters changes with time.
  void write_allowance(std::uint32_t slot);
  /// Takes in the device's verdict as it is by now.
  void look();
  enum class Watched { yes, no };
  /// Runs what follows a frame's last kick on the state as it is; with the watch or without.
  void run_frame_end(Watched watched);
  void forget_lists();
  void write_table(double frame_s, std::uint32_t substeps, std::uint32_t slot);
  void submit(FrameCommands::Chunk& chunk, Slot& slot);
  void finish(Slot& slot);
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
  SubmitPacer pacer_;
  std::array<Slot, kFrameSlots> slots_;
  Frame frame_;
  FrameLog log_;
  SpeedBudget budget_;
  double free_mass_ratio_;
  double hand_m_s_ = 0.0;  // speed of the fastest particle placed since the latest frame began
  std::vector<double> step_ms_;
  double part_ms_ = 0.0;
  Parity parity_ = 0;
  std::uint64_t frames_ = 0;
  std::uint32_t submits_ = 0;
  double time_s_ = 0;
};

std::optional<SelfCollisionReport> VulkanSimulation::self_collision() {
  if (!model_.scene.self_collision) return std::nullopt;
  wait();
  std::array<std::uint32_t, shared::kCollisionStateWords> words{};
  buffers_.at(BufferId::collision_state).read_finished(std::as_writable_bytes(std::span(words)));
  return report_of(words);
}

void VulkanSimulation::write_allowance(std::uint32_t slot) {
  write_energy_share(buffers_, slot, plan_, energy_share_s2_m2(free_mass_ratio_, budget_.allowed_m_s()));
}

void VulkanSimulation::look() {
  std::array<std::uint32_t, shared::kWatchStateWords> words{};
  buffers_.at(BufferId::watch_state).read_finished(std::as_writable_bytes(std::span(words)));
  log_.look(words);
}

void VulkanSimulation::write_table(double frame_s, std::uint32_t substeps, std::uint32_t slot) {
  const std::vector<KickDrift> rows = plan_.solver->schedule(time_s_, frame_s, substeps);
  const Bytes table = table_bytes(model_, plan_, rows, perturbation_);
  gpu::Buffer& buffer = buffers_.at(BufferId::substeps, slot);
  if (table.size() > buffer.bytes())
    throw error(Exit::internal,
                "a frame of {} substeps needs {} rows; the plan of {} substeps has room for {}", substeps,
                rows.size(), plan_.substeps, substep_row_capacity(plan_.row_count()));
  buffer.write_unused(table);
}

void VulkanSimulation::submit(FrameCommands::Chunk& chunk, Slot& slot) {
  if (slot.chunks.empty()) slot.start = Clock::now();
  slot.last_submit = device_.submit(chunk.commands.handle());
  slot.chunks.push_back(&chunk);
  parity_ = chunk.parity_after;
  ++submits_;
}

/// Waits for what the slot runs and adds its timings to the frame's.
void VulkanSimulation::finish(Slot& slot) {
  if (slot.chunks.empty()) return;
  device_.wait(slot.last_submit);
  double total_ms = 0;
  std::uint32_t dispatches = 0;
  for (const FrameCommands::Chunk* chunk : slot.chunks) {
    dispatches += chunk->dispatches;
    for (std::uint32_t run = 0; run < chunk->runs.size() && device_.info().timestamps; ++run) {
      const double ms = std::max(chunk->timer->between_ms(run, run + 1), 0.0);
      slot.times.add(chunk->runs[run], ms);
      total_ms += ms;
    }
  }
  if (device_.info().timestamps)
    step_ms_ = slot.times.result();
  else  // the wall clock is an upper bound: the submits also waited for others
    total_ms = std::chrono::duration<double, std::milli>(Clock::now() - slot.start).count();
  part_ms_ = total_ms;
  pacer_.measured(dispatches, total_ms);
  slot.chunks.clear();
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
  Slot& slot = slots_[slot_index];
  wait();  // for the verdict on all that was computed; not for pictures of it
  slot.times = StepTimes(plan_);
  write_table(frame_s, substeps, slot_index);
  budget_.elapse(model_.scene, frame_s, substeps, std::exchange(hand_m_s_, 0.0));
  write_allowance(slot_index);
  frame_ = {.slot = slot_index,
            .substeps = substeps,
            .done = 0,
            .start_s = time_s_,
            .length_s = frame_s,
            .order = DispatchOrder(plan_, substeps, choice_.kernel.substeps),
            .stats = {.substeps = substeps, .dispatches = 0, .spring_evaluations = 0}};
  submits_ = 0;
}

bool VulkanSimulation::continue_frame() {
  if (!frame_.order) return false;
  if (pacer_.learning()) finish(slots_[frame_.slot]);
  const DispatchOrder& order = *frame_.order;
  const std::uint32_t count = std::min(pacer_.chunk(), order.count() - frame_.done);
  const std::uint32_t n = order.independent_of_substeps(frame_.done, count) ? 0 : frame_.substeps;
  FrameCommands::Chunk& chunk = commands_.chunk({frame_.slot, parity_, frame_.done, count, n}, order);
  submit(chunk, slots_[frame_.slot]);
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
  for (const Slot& slot : slots_)
    if (!slot.chunks.empty() && !device_.wait_for(slot.last_submit, wait_s)) return false;
  wait();
  return true;
}

void VulkanSimulation::end_frame() {
  for (std::uint32_t place = 0; place < frame_.order->count(); ++place) {
    const DispatchOrder::Dispatch dispatch = (*frame_.order)[place];
    frame_.stats.spring_evaluations += dispatch.count * plan_.steps[dispatch.step].spring_evaluations;
  }
  time_s_ = frame_end_s(frame_.start_s, frame_.length_s);
  log_.end_frame(time_s_, frame_.length_s, frame_.substeps);
  frame_.order.reset();
}

State VulkanSimulation::read() {
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
  log_.begin(time_s_);
  const std::array<std::uint32_t, shared::kWatchStateWords> sound{};
  buffers_.at(BufferId::watch_state).write_unused(std::as_bytes(std::span(sound)));
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
      if (plan_.steps[step].block != Block::frame_end || program_.flips(step) || &pass == &carry ||
          &pass == &pair_check)
        continue;
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
  if (anew) write(state);
  return true;
}

void VulkanSimulation::place(std::span<const PlacedParticle> particles) {
  wait();
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
