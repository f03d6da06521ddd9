// The host decides a frame ahead: what the looks of the last one found says how far apart those of the next
// may be, and how much velocities may change meanwhile. At its end it reads whether that held.
#include "sim/gpu_spread_frames.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>

#include "passes/collision.h"
#include "passes/passes.h"
#include "passes/spread.h"
#include "plan/spread_words.h"
#include "sim/device_data.h"

namespace weft {
namespace {

/// Substeps between two looks: few different ones, so that recorded commands come again.
constexpr std::array<std::uint32_t, 11> kIntervals{128, 96, 64, 48, 32, 24, 16, 12, 8, 6, 4};
constexpr std::uint32_t kSubstepsLeast = 8;  // of a frame that is worth a look
constexpr double kFaster = 1.4;              // relative speeds until the frame's end, over those at its start
constexpr double kCautionLeast = 1.8, kCautionMost = 12.0, kHurryMost = 0.16;
static_assert(std::size(SpreadBound::kMargins) == shared::kSpreadMargins);

/// Adds the time from here to the end of the block.
class HostTime {
 public:
  explicit HostTime(double& ms) : ms_(ms) {}
  ~HostTime() { ms_ += std::chrono::duration<double, std::milli>(Clock::now() - began_).count(); }
  HostTime(const HostTime&) = delete;
  HostTime& operator=(const HostTime&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  double& ms_;
  Clock::time_point began_ = Clock::now();
};

double root_of(std::uint32_t bits) { return std::sqrt(double{std::bit_cast<float>(bits)}); }

}  // namespace

GpuSpreadFrames::GpuSpreadFrames(gpu::Device& device, const Model& model, const Plan& plan,
                                 GpuBuffers& buffers, const std::shared_ptr<GpuPipelines>& pipelines,
                                 const Kernel& kernel)
    : device_(device),
      buffers_(buffers),
      model_(model),
      plan_(plan),
      watch_(plan, model),
      program_(device, spread_frame(plan, model, 1), buffers, pipelines, kernel),
      shares_motion_(shares_motion(model)) {}

/// A look counts as one of pair_check, whose work it does.
GpuSpreadFrames::Commands::Commands(gpu::Device& device, const Plan& whole, Plan frame,
                                    const GpuProgram& program)
    : plan(std::move(frame)), recorded(device, plan, program) {
  for (const PlanStep& step : plan.steps) {
    const Pass* const pass = step.pass == &spread_look ? &pair_check : step.pass;
    const auto same = std::ranges::find_if(
        whole.steps, [&](const PlanStep& other) { return other.pass == pass && other.block == step.block; });
    step_of.push_back(static_cast<std::size_t>(same - whole.steps.begin()));
  }
}

/// Whoever is held back at a frame's end may be so again at the next one's start, by lists that there are.
bool GpuSpreadFrames::was_held() {
  const auto words = read_words<shared::kCollisionStateWords>(buffers_, BufferId::collision_state);
  return std::exchange(held_back_, words[shared::kHeldBack]) != words[shared::kHeldBack];
}

void GpuSpreadFrames::read_found() {
  const auto words = read_words<shared::kSpreadStateWords>(buffers_, BufferId::spread_state);
  words_.assign(words.begin(), words.end());
}

void GpuSpreadFrames::write_words(double kick_most_m_s) {
  begin_spread_words(words_, watch_.bound(), model_, kick_most_m_s, widest_);
  buffers_.at(BufferId::spread_state).write_unused(std::as_bytes(std::span(words_)));
}

/// That of the borders in the latest look, and the speed of the middle. Any would do; near the cloth's own
/// they find the most.
void GpuSpreadFrames::choose_plane() {
  const auto found = [&](std::uint32_t word) { return glm::dvec3(spread_vector(words_, word)); };
  put_spread_plane(words_, found(shared::kSpreadAlong), found(shared::kSpreadDown),
                   shares_motion_ ? found(shared::kSpreadMiddle) : glm::dvec3(0.0));
  has_plane_ = true;
}

/// The margin that there is; now and then a wider one, which may be there by now.
void GpuSpreadFrames::choose_widest(double margin) {
  constexpr std::uint32_t kFramesBetween = 8;
  const auto* const there = std::ranges::find(SpreadBound::kMargins, margin);
  widest_ = static_cast<std::uint32_t>(there - std::begin(SpreadBound::kMargins));
  if (widest_ > 0 && ++narrow_frames_ % kFramesBetween == 0) --widest_;
}

/// One substep into the state's other half, for what it would change of velocities, and a look.
void GpuSpreadFrames::look(Parity parity, std::uint32_t slot) {
  widest_ = 0;
  write_words(0.0);
  const Plan frame = spread_frame(plan_, model_, 1);
  device_.run_once([&](VkCommandBuffer commands) {
    gpu::Recorder recorder(device_, commands);
    for (const Pass* pass : {&integrate, &spread_look})
      for (std::size_t step = 0; step < frame.steps.size(); ++step)
        if (frame.steps[step].pass == pass && frame.steps[step].block == Block::substep)
          program_.dispatch(recorder, step, parity, slot, 0);
    recorder.finish();
  });
  read_found();
}

void GpuSpreadFrames::look_at_start(Parity parity, std::uint32_t slot) {
  if (has_plane_) look(parity, slot);
  if (!has_plane_ || found().margin < 0.0) {
    if (!has_plane_) look(parity, slot);
    choose_plane();
    look(parity, slot);
  }
  kick_m_s_ = 2.0 * root_of(words_[shared::kSpreadKick2]);  // a frame begins with half a kick
  known_ = true;
}

/// The worst of all looks since the words were written.
SpreadState GpuSpreadFrames::found() const {
  SpreadState state;
  const double longest_m = SpreadBound::kLongestEdge * model_.grid.spacing_m;
  if (!(root_of(words_[shared::kSpreadLongest2]) <= longest_m)) return state;
  constexpr double kUp = 1.0 + 1e-5;  // for what rounding took away
  state = {.margin = -1.0,
           .apart_m_s = kUp * root_of(words_[shared::kSpreadApart2]),
           .shared_m_s = glm::length(glm::dvec3(spread_vector(words_, shared::kSpreadShared))),
           .speed_m_s = kUp * root_of(words_[shared::kSpreadSpeed2]),
           .place_m = kUp * root_of(words_[shared::kSpreadPlace2])};
  for (std::uint32_t k = words_[shared::kSpreadFirst]; k < shared::kSpreadMargins && state.margin < 0.0; ++k)
    if ((words_[shared::kSpreadShort] >> k & 1u) == 0) state.margin = SpreadBound::kMargins[k];
  return state;
}

GpuSpreadFrames::Commands* GpuSpreadFrames::begin_frame(Parity parity, std::uint32_t slot, double drift_s,
                                                        std::uint32_t substeps) {
  if (substeps < kSubstepsLeast || !watch_.tries_frame()) return nullptr;
  if (!known_) {
    const HostTime taken(host_ms_);
    if (was_held()) return nullptr;
    look_at_start(parity, slot);
  }
  known_ = false;
  const SpreadState begin = found();
  if (begin.margin < 0.0) {
    watch_.pass_frames();
    return nullptr;
  }
  drift_s_ = drift_s;
  kick_most_m_s_ = caution_ * kick_m_s_;
  SpreadState later = begin;
  later.apart_m_s *= kFaster;
  later.margin *= hurry_;
  const auto* const interval =
      std::ranges::find_if(kIntervals, [&](std::uint32_t n) { return holds_between(later, n); });
  if (interval == kIntervals.end()) {
    end_frame(false);
    return nullptr;
  }
  interval_ = *interval;
  choose_plane();
  choose_widest(begin.margin);
  write_words(kick_most_m_s_);
  std::unique_ptr<Commands>& commands = commands_[interval_];
  if (!commands)
    commands = std::make_unique<Commands>(device_, plan_, spread_frame(plan_, model_, interval_), program_);
  if (commands->recorded.crowded()) commands->recorded.clear();
  return commands.get();
}

std::uint32_t GpuSpreadFrames::proven_before(const DispatchOrder& order) {
  constexpr std::uint32_t kWatching = 3;  // watch, judge, keep_sound end every frame
  return order.count() - kWatching;
}

bool GpuSpreadFrames::stayed_spread() {
  read_found();
  const SpreadState worst = found();
  const bool kicked = words_[shared::kSpreadKicked] != 0;
  if (kicked) caution_ = std::min(kCautionMost, 1.6 * caution_);
  const bool stayed = worst.margin > 0.0 && !kicked && holds_between(worst, interval_);
  if (!stayed && !kicked) hurry_ = std::max(kHurryMost, 0.4 * hurry_);
  end_frame(stayed);
  return stayed;
}

/// Whether a cloth that looks at worst so is spread in all of so many substeps between two looks: half of
/// them are within the margin of the one, half of the other, of which the last stands after the closing kick.
bool GpuSpreadFrames::holds_between(const SpreadState& worst, std::uint32_t substeps) const {
  const double kick_m_s = (1.0 + 1e-5) * kick_most_m_s_;
  return 2 * watch_.bound().substeps_within(worst, drift_s_, kick_m_s, substeps, 1) >= substeps;
}

void GpuSpreadFrames::end_frame(bool stayed) {
  watch_.end_frame(stayed);
  known_ = stayed;
  if (!stayed) return;
  kick_m_s_ = root_of(words_[shared::kSpreadKick2]);
  caution_ = std::max(kCautionLeast, 0.95 * caution_);
  hurry_ = std::min(1.0, 1.03 * hurry_);
}

void GpuSpreadFrames::take_back(Parity parity) {
  const HostTime taken(host_ms_);
  buffers_.at(at_parity(BufferId::position, parity)).copy_unused(buffers_.at(BufferId::kept_position));
  buffers_.at(at_parity(BufferId::velocity, parity)).copy_unused(buffers_.at(BufferId::kept_velocity));
}

}  // namespace weft
