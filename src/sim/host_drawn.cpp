// One mutex orders everything: whoever holds it while no part is being computed may touch the simulation.
#include "sim/host_drawn.h"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "sim/draw_pairs.h"

namespace weft {
namespace {

constexpr double kPart_s = 0.006;                  ///< computed in one go: what a stop waits for
constexpr std::chrono::milliseconds kPatience{8};  ///< that continue_frame() waits for the frame's end

class HostDrawn final : public DrawnSimulation {
 public:
  HostDrawn(gpu::Device& device, std::unique_ptr<HostSimulation> simulation)
      : simulation_(std::move(simulation)), pairs_(device, simulation_->model()) {
    note_facts();
    show_now();
    thread_ = std::thread([this] { work(); });
  }
  ~HostDrawn() override {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
      running_ = false;
    }
    changed_.notify_all();
    thread_.join();
  }
  HostDrawn(const HostDrawn&) = delete;
  HostDrawn& operator=(const HostDrawn&) = delete;

  const Model& model() const override { return simulation_->model(); }
  const Plan& plan() const override { return simulation_->plan(); }
  std::string device_name() const override { return facts().device_name; }
  double time_s() const override { return facts().time_s; }
  std::optional<Divergence> divergence() const override { return facts().divergence; }
  std::vector<double> step_ms() const override { return facts().step_ms; }
  DrawBuffers draw_buffers() const override { return pairs_.shown(); }
  std::uint64_t bytes_allocated() const override { return bytes_; }

  State read() override {
    const auto stopped = stop();
    return simulation_->read();
  }
  void write(const State& state) override {
    const auto stopped = stop();
    simulation_->write(state);
    under_way_ = ended_ = false;
    show_now();
  }
  std::optional<State> last_good() override {
    const auto stopped = stop();
    return simulation_->last_good();
  }
  std::optional<SelfCollisionReport> self_collision() override {
    const auto stopped = stop();
    return simulation_->self_collision();
  }
  bool adopt(const Model& model) override {
    const auto stopped = stop();
    if (!simulation_->adopt(model)) return false;
    under_way_ = ended_ = false;
    show_now();
    return true;
  }
  void place(std::span<const PlacedParticle> particles) override {
    const auto stopped = stop();
    simulation_->place(particles);
  }

  FrameStats advance(double frame_s, std::uint32_t substeps) override {
    begin_frame(frame_s, substeps);
    while (continue_frame()) {
    }
    return simulation_->frame_stats();
  }
  void begin_frame(double frame_s, std::uint32_t substeps) override {
    const auto stopped = stop();
    simulation_->begin_frame(frame_s, substeps);
    under_way_ = true;
    ended_ = false;
  }
  bool continue_frame() override;
  /// Nothing is left behind: the thread goes on by itself.
  void wait() override {}
  void refresh_normals() override;

 private:
  using Lock = std::unique_lock<std::mutex>;
  /// What others may ask for while a part is being computed.
  struct Facts {
    std::string device_name;
    double time_s = 0.0;
    std::optional<Divergence> divergence;
    std::vector<double> step_ms;
  };
  Facts facts() const {
    const std::lock_guard lock(mutex_);
    return facts_;
  }
  void note_facts();
  /// Lets the part being computed end; none is begun before the next continue_frame().
  Lock stop();
  void rethrow();
  void show_now();
  void work();
  void compute_part(Lock& lock);

  std::unique_ptr<HostSimulation> simulation_;
  DrawPairs pairs_;
  std::uint64_t bytes_ = simulation_->bytes_allocated() + pairs_.bytes();
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Facts facts_;
  native::SurfaceTarget target_{};
  bool under_way_ = false;      ///< a frame is begun and not yet seen to be done
  bool running_ = false;        ///< the thread may compute its parts
  bool computing_ = false;      ///< one is being computed
  bool ended_ = false;          ///< the frame is done and stands in target_
  bool picture_due_ = false;    ///< the next part's end is to be written to target_
  bool picture_ready_ = false;  ///< it is, and the thread waits for another target
  bool stopping_ = false;
  std::exception_ptr failure_;
  std::thread thread_;
};

void HostDrawn::note_facts() {
  facts_ = {simulation_->device_name(), simulation_->time_s(), simulation_->divergence(),
            simulation_->step_ms()};
}

HostDrawn::Lock HostDrawn::stop() {
  Lock lock(mutex_);
  running_ = false;
  changed_.wait(lock, [&] { return !computing_; });
  rethrow();
  return lock;
}

void HostDrawn::rethrow() {
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

/// With the thread stopped.
void HostDrawn::show_now() {
  simulation_->write_drawn(pairs_.target());
  pairs_.show();
  note_facts();
}

bool HostDrawn::continue_frame() {
  Lock lock(mutex_);
  if (!under_way_) return false;
  if (!running_) {
    target_ = pairs_.target();
    running_ = true;
    changed_.notify_all();
  }
  changed_.wait_for(lock, kPatience, [&] { return ended_ || failure_; });
  rethrow();
  if (!ended_) return true;
  ended_ = under_way_ = false;
  pairs_.show();
  return false;
}

/// While the thread runs it writes the picture after its part, and goes on when it has another target.
void HostDrawn::refresh_normals() {
  Lock lock(mutex_);
  if (ended_) return;  // continue_frame() will show it
  if (!running_) {
    changed_.wait(lock, [&] { return !computing_; });
    return show_now();
  }
  picture_due_ = true;
  changed_.wait(lock, [&] { return picture_ready_ || ended_ || failure_; });
  picture_due_ = false;
  rethrow();
  if (!std::exchange(picture_ready_, false)) return;
  pairs_.show();
  target_ = pairs_.target();
  changed_.notify_all();
}

void HostDrawn::work() {
  Lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return (running_ && !picture_ready_) || stopping_; });
    if (stopping_) return;
    compute_part(lock);
    changed_.notify_all();
  }
}

/// The simulation and the target are this thread's while computing_ is set.
void HostDrawn::compute_part(Lock& lock) {
  computing_ = true;
  const bool picture = picture_due_;
  lock.unlock();
  bool more = false;
  std::exception_ptr failure;
  try {
    more = simulation_->continue_frame(kPart_s);
    if (!more || picture) simulation_->write_drawn(target_);
  } catch (...) {
    failure = std::current_exception();
  }
  lock.lock();
  computing_ = false;
  failure_ = failure;
  note_facts();
  picture_ready_ = picture && more && !failure;
  if (more && !failure) return;
  running_ = false;
  ended_ = !failure;
}

}  // namespace

std::unique_ptr<DrawnSimulation> draw_host_simulation(gpu::Device& device,
                                                      std::unique_ptr<HostSimulation> simulation) {
  return std::make_unique<HostDrawn>(device, std::move(simulation));
}

}  // namespace weft
