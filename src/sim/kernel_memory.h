// The kernels that trials found fastest, kept in a small JSON file from run to run.
#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "sim/kernels.h"

namespace weft {

/// What a trial's result depends on beside the device and driver, which the file's name says: grid and
/// constants.
std::string kernel_memory_key(const Plan&);

/// Empty when the file is missing, damaged, of another version, or does not know the key.
std::optional<Kernel> remembered_kernel(const std::filesystem::path& file, const std::string& key);

/// Adds or replaces one entry; the file appears whole or not at all. What cannot be written is let go: the
/// next run tries again.
void remember_kernel(const std::filesystem::path& file, const std::string& key, const Kernel& kernel);

}  // namespace weft
