// Linux tells by the thread's affinity and the control groups' quotas; elsewhere, or where a machine has more
// than the mask holds, all count.
#include "core/cores.h"

#ifdef __linux__
#include <sched.h>
#endif

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>

namespace weft {
namespace fs = std::filesystem;
namespace {

std::uint32_t cores_of_affinity() {
#ifdef __linux__
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  if (sched_getaffinity(0, sizeof allowed, &allowed) == 0)
    return static_cast<std::uint32_t>(std::max(1, CPU_COUNT(&allowed)));
#endif
  return std::max(1u, std::thread::hardware_concurrency());
}

/// A file of one or two numbers; "max" and what else is no number is none.
std::optional<double> number_in(std::istream& file) {
  double value = 0.0;
  return file >> value && std::isfinite(value) && value > 0.0 ? std::optional(value) : std::nullopt;
}

/// The quota over its period, of one group.
std::optional<double> quota_of(const fs::path& group) {
  std::ifstream both(group / "cpu.max");  // version 2
  if (const auto quota = number_in(both))
    if (const auto period = number_in(both)) return *quota / *period;
  std::ifstream quota_file(group / "cpu.cfs_quota_us"), period_file(group / "cpu.cfs_period_us");
  if (const auto quota = number_in(quota_file))  // −1: none
    if (const auto period = number_in(period_file)) return *quota / *period;
  return std::nullopt;
}

/// The least of a group and those above it, up to the mount. In a container the path may be the host's, of
/// which the mount has only the end: then the mount itself is the group.
std::optional<double> least_quota(const fs::path& mount, fs::path group) {
  std::optional<double> least;
  for (group = group.lexically_normal();; group = group.parent_path()) {
    if (const auto quota = quota_of(mount / group.relative_path()))
      least = std::min(*quota, least.value_or(*quota));
    if (!group.has_relative_path()) return least;
  }
}

bool has_controller(std::string_view controllers, std::string_view name) {
  return (',' + std::string(controllers) + ',').find(',' + std::string(name) + ',') != std::string::npos;
}

}  // namespace

std::optional<std::uint32_t> quota_cores(const fs::path& groups, const fs::path& mounts) {
  std::optional<double> least;
  std::ifstream lines(groups);
  for (std::string line; std::getline(lines, line);) {  // "4:cpu,cpuacct:/path", "0::/path" for version 2
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    if (!controllers.empty() && !has_controller(controllers, "cpu")) continue;
    const std::optional<double> quota = least_quota(mounts / controllers, line.substr(second + 1));
    if (quota) least = std::min(*quota, least.value_or(*quota));
  }
  if (!least) return std::nullopt;
  return static_cast<std::uint32_t>(std::clamp(std::ceil(*least), 1.0, 1e6));
}

std::uint32_t usable_cores() {
  const std::uint32_t allowed = cores_of_affinity();
  return std::min(allowed, quota_cores().value_or(allowed));
}

}  // namespace weft
