// Draws the bar with one carriage return a redraw.
#include "cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <iostream>
#include <utility>

namespace weft::cli {

Progress::Progress(std::string what, bool quiet)
    : what_(std::move(what)),
      visible_(!quiet && isatty(STDERR_FILENO) == 1),
      started_(std::chrono::steady_clock::now()),
      latest_(started_) {}

Progress::~Progress() {
  if (drawn_) std::cerr << "\r\x1b[K" << std::flush;
}

void Progress::show(std::uint64_t done, std::uint64_t total) {
  using namespace std::chrono_literals;
  const auto now = std::chrono::steady_clock::now();
  if (!visible_ || total == 0 || now - latest_ < 100ms) return;
  latest_ = now;
  drawn_ = true;
  constexpr std::size_t kWidth = 30;
  const double share = static_cast<double>(done) / static_cast<double>(total);
  const auto filled = static_cast<std::size_t>(share * kWidth);
  const double spent_s = std::chrono::duration<double>(now - started_).count();
  std::cerr << fmt::format("\r\x1b[K{} [{}{}] {}/{}, {:.0f} s left", what_, std::string(filled, '#'),
                           std::string(kWidth - filled, '.'), done, total,
                           share > 0.0 ? spent_s / share - spent_s : 0.0)
            << std::flush;
}

}  // namespace weft::cli
