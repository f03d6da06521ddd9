// Puts cloth, kernel and threads together.
#include "native/engine.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "core/error.h"
#include "native/features.h"
#include "passes/integrate.h"
#include "passes/passes.h"

namespace weft::native {
namespace {

constexpr std::uint32_t kThreadsMax = 1024;

std::uint32_t threads_asked(std::uint32_t option) {
  const char* text = std::getenv("WEFT_THREADS");
  if (option != 0 || text == nullptr) return option;
  std::uint32_t count = 0;
  const char* const end = text + std::strlen(text);
  const auto [stopped, failure] = std::from_chars(text, end, count);
  if (failure != std::errc() || stopped != end || count < 1 || count > kThreadsMax)
    throw error(Exit::usage, "WEFT_THREADS is \"{}\"; it must be a number of threads from 1 to {}", text,
                kThreadsMax);
  return count;
}

ThreadChoice choice_for(const Cloth& cloth, std::uint32_t asked) {
  const auto rows_allow = static_cast<std::uint32_t>(std::max<std::size_t>(1, cloth.ny() / kRowsPerBandMin));
  if (asked != 0) return ThreadChoice::fixed(std::min(asked, rows_allow));
  const std::uint32_t cores = std::clamp(std::thread::hardware_concurrency(), 1u, kThreadsMax);
  return ThreadChoice(std::min(cores, rows_allow), cloth.nx() * cloth.ny());
}

}  // namespace

std::string unsupported(const Plan& plan) {
  if (plan.precision != "f32") return "native computes in f32 only";
  for (const PlanStep& step : plan.steps) {
    if (step.block == weft::Block::frame_end && !step.pass->swaps_state) continue;
    if (step.pass != &integrate || step.block == weft::Block::frame_start)
      return fmt::format("native has no vector code for the pass {}", step.pass->name);
    for (const Constant& constant : step.constants)
      if (constant.value != 0 && std::ranges::count(kIntegrateConstantNames, constant.name) == 0)
        return fmt::format("native has no vector code for {}", constant.name);
  }
  return {};
}

Engine::Engine(const Model& model, std::span<const Constant> constants, const EngineOptions& options)
    : cloth_(model, constants),
      kernels_(find_kernels(options.vector)),
      choice_(choice_for(cloth_, threads_asked(options.threads))) {}

Bands& Engine::bands(std::uint32_t count) {
  if (crew_ == nullptr || crew_->size() < count) crew_ = std::make_unique<Crew>(count - 1);
  auto& made = bands_[count];
  if (made == nullptr) made = std::make_unique<Bands>(cloth_, kernels_, count);
  return *made;
}

void Engine::sweep(std::span<const Kick> kicks) {
  using Clock = std::chrono::steady_clock;
  while (!kicks.empty()) {
    const Turn turn = choice_.next(static_cast<std::uint32_t>(kicks.size()));
    Bands& divided = bands(turn.threads);
    const auto began = Clock::now();
    divided.sweep(*crew_, kicks.first(turn.substeps));
    choice_.report(turn, std::chrono::duration<double>(Clock::now() - began).count());
    kicks = kicks.subspan(turn.substeps);
  }
}

void Engine::write_surface(const SurfaceTarget& target) {
  Bands& divided = bands(choice_.best());
  divided.surface(*crew_,
                  {.position = target.position, .velocity = target.velocity, .normal = target.normal});
}

}  // namespace weft::native
