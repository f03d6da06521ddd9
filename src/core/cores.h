// How many of the machine's cores this program may use.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>

namespace weft {

/// Those that the system lets the calling thread run on (taskset, a container's set of cores), and no more
/// than its quota of processor time keeps busy; at least 1. The standard library counts all of the machine's;
/// threads beyond the allowed ones only wait for each other.
std::uint32_t usable_cores();

/// What the control groups' quotas of processor time amount to in cores, rounded up, at least 1: the least of
/// this process's group and those above it. Nothing where there is no quota, or none that can be read.
/// @param groups  the process's groups, as Linux lists them
/// @param mounts  where the groups are files: those of version 2, and folders of controllers of version 1
std::optional<std::uint32_t> quota_cores(const std::filesystem::path& groups = "/proc/self/cgroup",
                                         const std::filesystem::path& mounts = "/sys/fs/cgroup");

}  // namespace weft
