// One mutex orders everything: whoever holds it while no part is being computed may touch the simulation.
#include "sim/host_drawn.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "sim/draw_pairs.h"

namespace weft {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kPart_s = 0.006;                  ///< computed in one go: what a stop waits for
constexpr std::chrono::milliseconds kPatience{8};  ///< that continue_frame() waits for the frame's end

Clock::duration duration_of(double wall_s) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(wall_s));
}

double milliseconds_since(Clock::time_point began) {
  return std::chrono::duration<double, std::milli>(Clock::now() - began).count();
}

class HostDrawn final : public HostDrawnSimulation {
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
  double latest_frame_ms() const override { return facts().frame_ms; }
  DrawBuffers draw_buffers() const override { return pairs_.shown(); }
  double shown_time_s() const override { return shown_time_s_; }
  std::uint64_t bytes_allocated() const override { return bytes_; }

  State read() override {
    const auto held = hold();
    return simulation_->read();
  }
  std::optional<State> last_good() override {
    const auto held = hold();
    return simulation_->last_good();
  }
  std::optional<SelfCollisionReport> self_collision() override {
    const auto held = hold();
    return simulation_->self_collision();
  }
  void write(const State& state) override {
    const auto stopped = stop();
    simulation_->write(state);
    drop_frame();
  }
  bool adopt(const Model& model) override {
    const auto stopped = stop();
    if (!simulation_->adopt(model)) return false;
    drop_frame();
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
  void begin_frame(double frame_s, std::uint32_t substeps) override;
  bool continue_frame() override;
  /// Nothing is left behind: the thread goes on by itself.
  void wait() override {}
  bool await_part(double) override { return true; }
  double part_ms() const override { return part_ms_; }
  void refresh_normals() override;

  FramesDone go_on(const OwedFrames& frames) override;
  FramesDone stay() override {
    const auto stopped = stop();
    by_itself_ = false;
    return take_done();
  }
  bool show_latest(double wait_s) override;
  void want_middle() override { picture_due_ = true; }

 private:
  using Lock = std::unique_lock<std::mutex>;
  /// What others may ask for while a part is being computed.
  struct Facts {
    std::string device_name;
    double time_s = 0.0, frame_ms = 0.0;
    std::optional<Divergence> divergence;
    std::vector<double> step_ms;
  };
  Facts facts() const {
    const std::lock_guard lock(mutex_);
    return facts_;
  }
  void note_facts();
  /// Lets the part being computed end; none is begun before the next continue_frame() or go_on().
  Lock stop();
  /// The same for as long as the lock is held.
  Lock hold();
  void rethrow();
  void drop_frame();
  void show_now();
  void show_ready();
  FramesDone take_done();
  void work();
  bool frame_owed() const { return by_itself_ && left_ > 0 && Clock::now() >= due_; }
  void compute_part(Lock& lock);
  void note_part(bool more, double ms);

  std::unique_ptr<HostSimulation> simulation_;
  DrawPairs pairs_;
  std::uint64_t bytes_ = simulation_->bytes_allocated() + pairs_.bytes();
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Facts facts_;
  DrawPairs::Taken writing_ = pairs_.take();  ///< the thread's while computing_ is set
  DrawPairs::Taken ready_ = pairs_.take();    ///< where the latest picture is, if is_ready_
  bool is_ready_ = false;
  double ready_time_s_ = 0.0, shown_time_s_ = 0.0, part_ms_ = 0.0;
  bool under_way_ = false;                       ///< a frame is begun and not done
  double frame_start_s_ = 0.0, frame_ms_ = 0.0;  ///< of that one
  double told_ms_ = 0.0;                         ///< of those milliseconds, what part_ms() has told
  bool running_ = false;                         ///< the thread may compute
  bool computing_ = false;                       ///< it does
  bool ended_ = false;                           ///< a frame is done that continue_frame() has not told of
  bool by_itself_ = false;                       ///< frames count in done_, and others follow
  OwedFrames next_;                              ///< what follows,
  Clock::time_point due_;                        ///< not before,
  std::uint32_t left_ = 0;                       ///< so often at most
  FramesDone done_;
  std::uint32_t holders_ = 0;             ///< who waits for a pause between two parts
  std::atomic<bool> picture_due_{false};  ///< the part being computed is to be written at its end
  bool stopping_ = false;
  std::exception_ptr failure_;
  std::thread thread_;
};

void HostDrawn::note_facts() {
  facts_ = {simulation_->device_name(), simulation_->time_s(), facts_.frame_ms, simulation_->divergence(),
            simulation_->step_ms()};
}

HostDrawn::Lock HostDrawn::stop() {
  Lock lock(mutex_);
  running_ = false;
  changed_.wait(lock, [&] { return !computing_; });
  rethrow();
  return lock;
}

HostDrawn::Lock HostDrawn::hold() {
  Lock lock(mutex_);
  ++holders_;
  changed_.wait(lock, [&] { return !computing_; });
  --holders_;
  changed_.notify_all();  // heard when the lock is given back
  rethrow();
  return lock;
}

void HostDrawn::rethrow() {
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

/// With the thread stopped: the state is another one.
void HostDrawn::drop_frame() {
  under_way_ = ended_ = by_itself_ = false;
  show_now();
}

/// With nothing being computed.
void HostDrawn::show_now() {
  simulation_->write_drawn(writing_.surface);
  pairs_.show(writing_);
  writing_ = pairs_.take();
  is_ready_ = false;
  note_facts();
  shown_time_s_ = facts_.time_s;
}

void HostDrawn::show_ready() {
  if (!std::exchange(is_ready_, false)) return;
  pairs_.show(ready_);
  ready_ = pairs_.take();
  shown_time_s_ = ready_time_s_;
}

void HostDrawn::begin_frame(double frame_s, std::uint32_t substeps) {
  const auto stopped = stop();
  simulation_->begin_frame(frame_s, substeps);
  frame_start_s_ = simulation_->time_s();
  frame_ms_ = told_ms_ = 0.0;
  under_way_ = true;
  ended_ = by_itself_ = false;
}

bool HostDrawn::continue_frame() {
  Lock lock(mutex_);
  by_itself_ = false;
  if (under_way_ && !running_) {
    running_ = true;
    changed_.notify_all();
  }
  changed_.wait_for(lock, kPatience, [&] { return !under_way_ || failure_; });
  // What the thread did since the last call counts, too: a part may outlast the patience.
  part_ms_ = frame_ms_ - std::exchange(told_ms_, frame_ms_);
  rethrow();
  if (under_way_) return true;
  ended_ = false;
  show_ready();
  return false;
}

/// While the thread runs it writes the picture after its part.
void HostDrawn::refresh_normals() {
  Lock lock(mutex_);
  if (!is_ready_ && !(running_ && under_way_)) {
    changed_.wait(lock, [&] { return !computing_; });
    return show_now();
  }
  picture_due_ = true;
  changed_.wait(lock, [&] { return is_ready_ || !running_ || failure_; });
  picture_due_ = false;
  rethrow();
  show_ready();
}

FramesDone HostDrawn::take_done() {
  FramesDone done = std::exchange(done_, {});
  if (std::exchange(ended_, false)) {  // begun by begin_frame(), and nobody asked since
    ++done.frames;
    done.computed_ms += facts_.frame_ms;
  }
  done.under_way = under_way_;
  if (!under_way_) return done;
  done.part_s = facts_.time_s - frame_start_s_;
  done.part_ms = told_ms_ = frame_ms_;
  return done;
}

FramesDone HostDrawn::go_on(const OwedFrames& frames) {
  const Lock lock(mutex_);
  rethrow();
  const FramesDone done = take_done();
  next_ = frames;
  const double to_begin = frames.owed - done.frames - (under_way_ ? 1.0 : 0.0);  // 1: it is owed now
  left_ = static_cast<std::uint32_t>(std::max(to_begin, 0.0) + std::max(1.0, kAhead_s / frames.period_s));
  due_ = Clock::now() + duration_of(std::clamp((1.0 - to_begin) * frames.period_s, -1e6, 1e6));
  by_itself_ = running_ = !facts_.divergence;
  changed_.notify_all();
  return done;
}

bool HostDrawn::show_latest(double wait_s) {
  Lock lock(mutex_);
  if (wait_s > 0.0)
    changed_.wait_for(lock, duration_of(wait_s), [&] { return is_ready_ || !running_ || failure_; });
  rethrow();
  const bool is_new = is_ready_;
  show_ready();
  return is_new;
}

void HostDrawn::work() {
  Lock lock(mutex_);
  while (!stopping_) {
    if (!running_ || holders_ > 0) {
      changed_.wait(lock);
    } else if (under_way_ || frame_owed()) {
      compute_part(lock);
      changed_.notify_all();
    } else if (by_itself_ && left_ > 0) {
      changed_.wait_until(lock, due_);
    } else {
      changed_.wait(lock);
    }
  }
}

/// The simulation and writing_ are this thread's while computing_ is set.
void HostDrawn::compute_part(Lock& lock) {
  computing_ = true;
  const bool begins = !std::exchange(under_way_, true);
  if (begins) {
    frame_start_s_ = facts_.time_s;
    frame_ms_ = told_ms_ = 0.0;
    --left_;
    due_ += duration_of(next_.period_s);
  }
  const OwedFrames next = next_;
  lock.unlock();
  const Clock::time_point began = Clock::now();
  bool more = false, written = false;
  std::exception_ptr failure;
  try {
    if (begins) simulation_->begin_frame(next.frame_s, next.substeps);
    more = simulation_->continue_frame(kPart_s);
    written = !more || picture_due_;
    if (written) simulation_->write_drawn(writing_.surface);
  } catch (...) {
    failure = std::current_exception();
  }
  const double ms = milliseconds_since(began);
  lock.lock();
  computing_ = false;
  failure_ = failure;
  if (failure) {
    running_ = under_way_ = by_itself_ = false;
    return;
  }
  note_part(more, ms);
  if (!written) return;
  std::swap(writing_, ready_);
  is_ready_ = true;
  picture_due_ = false;
  ready_time_s_ = facts_.time_s;
}

void HostDrawn::note_part(bool more, double ms) {
  frame_ms_ += ms;
  under_way_ = more;
  if (!more) facts_.frame_ms = frame_ms_;
  note_facts();
  if (more) return;
  if (by_itself_) {
    ++done_.frames;
    done_.computed_ms += frame_ms_;
  } else {
    ended_ = true;
  }
  if (!by_itself_ || facts_.divergence) running_ = by_itself_ = false;
}

}  // namespace

std::unique_ptr<HostDrawnSimulation> draw_host_simulation(gpu::Device& device,
                                                          std::unique_ptr<HostSimulation> simulation) {
  return std::make_unique<HostDrawn>(device, std::move(simulation));
}

}  // namespace weft
