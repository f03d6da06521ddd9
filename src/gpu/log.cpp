// The logger of src/gpu.
#include "gpu/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>

#include <mutex>

namespace weft::gpu {

std::shared_ptr<spdlog::logger> log() {
  static std::mutex making;  // messages may come from any of the driver's threads
  const std::lock_guard lock(making);
  if (auto known = spdlog::get("weft")) return known;
  auto made = spdlog::stderr_color_mt("weft");
  made->set_pattern("weft: %l: %v");  // as the program's own lines
  return made;
}

void set_quiet(bool quiet) { log()->set_level(quiet ? spdlog::level::err : spdlog::level::info); }

}  // namespace weft::gpu
