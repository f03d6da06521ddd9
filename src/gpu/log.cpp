// The logger of src/gpu.
#include "gpu/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>

#include <mutex>

namespace weft::gpu {

std::shared_ptr<spdlog::logger> log() {
  static std::mutex making;  // messages may come from any of the driver's threads
  const std::lock_guard lock(making);
  if (auto known = spdlog::get("weft")) return known;
  return spdlog::stderr_color_mt("weft");
}

}  // namespace weft::gpu
