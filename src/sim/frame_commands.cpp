// Prerecorded command buffers: a frame's dispatches cut into chunks.
#include "sim/frame_commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/error.h"

namespace weft {

DispatchOrder::DispatchOrder(const Plan& plan, std::uint32_t substeps, std::uint32_t at_once)
    : substeps_(substeps), at_once_(at_once) {
  for (const PlanStep& step : plan.steps) {
    start_ += step.block == Block::frame_start ? 1 : 0;
    block_ += step.block == Block::substep ? 1 : 0;
    end_ += step.block == Block::frame_end ? 1 : 0;
    period_substeps_ = std::lcm(period_substeps_, step.interval);
  }
  WEFT_ASSERT(at_once == 1 || (block_ == 1 && period_substeps_ == 1));
  period_substeps_ *= at_once;
  std::uint32_t rest = 0;  // dispatches of the substeps after the last whole period
  for (std::uint32_t k = 0; k < period_substeps_; k += at_once)
    for (std::size_t step = start_; step < start_ + block_; ++step)
      if (k % plan.steps[step].interval == 0) {
        period_.push_back({step, k, at_once});
        rest += k < substeps % period_substeps_ ? 1 : 0;
      }
  end_first_ = start_ + substeps / period_substeps_ * static_cast<std::uint32_t>(period_.size()) + rest;
}

DispatchOrder::Dispatch DispatchOrder::operator[](std::uint32_t place) const {
  if (place < start_) return {place, 0, 1};
  if (place >= end_first_) return {start_ + block_ + (place - end_first_), substeps_, 1};
  const std::uint32_t inside = place - start_, whole = static_cast<std::uint32_t>(period_.size());
  const Dispatch& dispatch = period_[inside % whole];
  const std::uint32_t substep = inside / whole * period_substeps_ + dispatch.substep;
  return {dispatch.step, substep, std::min(dispatch.count, substeps_ - substep)};
}

bool DispatchOrder::independent_of_substeps(std::uint32_t first, std::uint32_t count) const {
  if (at_once_ > 1) return first + count <= start_ + substeps_ / at_once_;  // the last takes what is left
  return first + count <= end_first_;
}

FrameCommands::Chunk& FrameCommands::chunk(const ChunkKey& key, const DispatchOrder& order) {
  std::unique_ptr<Chunk>& chunk = chunks_[key];
  if (!chunk) {
    chunk = record(key, order);
    ++recorded_;
  }
  return *chunk;
}

std::unique_ptr<FrameCommands::Chunk> FrameCommands::record(const ChunkKey& key,
                                                            const DispatchOrder& order) const {
  auto chunk = std::make_unique<Chunk>();
  for (std::uint32_t place = key.first; place < key.first + key.count; ++place)
    if (const TimedRun run = run_at(order, place); chunk->runs.empty() || chunk->runs.back() != run)
      chunk->runs.push_back(run);
  const std::string name = fmt::format("dispatches {} to {}", key.first, key.first + key.count - 1);
  chunk->commands = gpu::Commands(device_, name, gpu::Reuse::many);
  const VkCommandBuffer commands = chunk->commands.begin();
  chunk->timer = std::make_unique<gpu::Timer>(device_, static_cast<std::uint32_t>(chunk->runs.size() + 1));
  chunk->timer->reset(commands);
  chunk->timer->stamp(commands, 0);
  {
    gpu::Recorder recorder(device_, commands);
    Parity parity = key.parity;
    std::uint32_t run = 0;
    for (std::uint32_t place = key.first; place < key.first + key.count; ++place) {
      const auto [step, substep, count] = order[place];
      const bool first = place == key.first, another = first || order[place - 1].step != step;
      if (another && !first) recorder.end_label();
      if (run_at(order, place) != chunk->runs[run]) chunk->timer->stamp(commands, ++run);
      if (another) recorder.label(plan_.steps[step].pass->name);
      program_.dispatch(recorder, step, parity, key.slot, plan_.table_row(plan_.steps[step], substep), count);
      if (program_.flips(step)) parity ^= 1u;
    }
    recorder.end_label();
    chunk->timer->stamp(commands, run + 1);
    recorder.finish();
    chunk->parity_after = parity;
    chunk->dispatches = static_cast<std::uint32_t>(recorder.dispatch_count());
  }
  chunk->commands.end();
  return chunk;
}

}  // namespace weft
