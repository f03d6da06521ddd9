// Live estimates: the copy is a simulation like any other, written to and read from.
#include "study/live.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "model/measures.h"

namespace weft::study {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kPart_s = 0.03;  // of the work on the CPU in one go

double ms_since(Clock::time_point began) {
  return std::chrono::duration<double, std::milli>(Clock::now() - began).count();
}

}  // namespace

std::optional<double> measured_error_m(const std::vector<Point>& points, const Setting& setting) {
  const Point *below = nullptr, *above = nullptr;
  for (const Point& point : points) {
    const Setting& s = point.setting;
    if (s.solver != setting.solver || s.precision != setting.precision) continue;
    if (s.substeps <= setting.substeps && (below == nullptr || s.substeps > below->setting.substeps))
      below = &point;
    if (s.substeps >= setting.substeps && (above == nullptr || s.substeps < above->setting.substeps))
      above = &point;
  }
  if (below == nullptr || above == nullptr || below->diverged || above->diverged) return {};
  if (below == above) return below->error_m;
  const auto log_substeps = [](const Setting& s) { return std::log(static_cast<double>(s.substeps)); };
  const double share = (log_substeps(setting) - log_substeps(below->setting)) /
                       (log_substeps(above->setting) - log_substeps(below->setting));
  return std::exp((1.0 - share) * std::log(below->error_m) + share * std::log(above->error_m));
}

LiveError::LiveError(const Bench& bench, const Model& model, const Setting& setting)
    : substeps_(2 * setting.substeps),
      model_(with_setting(model, {setting.solver, setting.precision, substeps_})) {
  const Solver& solver = find_solver(setting.solver);
  if (bench.device == nullptr) {
    auto on_host = bench.on_host(model_, solver, setting.precision);
    on_host_ = on_host.get();
    copy_ = std::move(on_host);
    return;
  }
  auto on_gpu =
      GpuSimulation::create(*bench.device, model_, solver, {.perturb = {}, .pipelines = bench.pipelines});
  on_gpu_ = on_gpu.get();
  copy_ = std::move(on_gpu);
}

LiveError::~LiveError() = default;

void LiveError::begin(const State& before, const State& after, double frame_s) {
  const auto began = Clock::now();
  copy_->write(before);
  after_ = after;
  if (on_gpu_ != nullptr) on_gpu_->begin_frame(frame_s, substeps_);
  if (on_host_ != nullptr) on_host_->begin_frame(frame_s, substeps_);
  under_way_ = true;
  spent_ms_ = ms_since(began);
}

std::optional<double> LiveError::go_on() {
  if (!under_way_) return {};
  const auto began = Clock::now();
  const bool more = on_gpu_ != nullptr ? on_gpu_->continue_frame() : on_host_->continue_frame(kPart_s);
  std::optional<double> error_m;
  if (!more) error_m = frame_distance(copy_->read(), after_);
  spent_ms_ += ms_since(began);
  if (more) return {};
  under_way_ = false;
  cost_ms_ = spent_ms_;
  return error_m;
}

void History::add(const Model& model, const State& state) {
  if (!samples_.empty() && state.time_s < samples_.back().time_s) samples_.clear();
  if (!samples_.empty() && state.time_s == samples_.back().time_s) return;
  const Stretch stretched = stretch(model, state);
  samples_.push_back({state.time_s, stretched.maximum, stretched.p99, energy(model, state).total()});
  while (samples_.size() > capacity_) samples_.pop_front();
}

}  // namespace weft::study
