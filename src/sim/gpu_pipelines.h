// Compute pipelines by module and constants, shared by simulations that follow one another on a device, so
// that another resolution or another scene compiles only what is new to it. For any thread.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "gpu/pipeline.h"

namespace weft {

class GpuPipelines {
 public:
  /// @param lacking  a constant of `integrate` whose effect the kernels shall not even have as text, for the
  /// benchmark
  ///                 alone; empty: none
  explicit GpuPipelines(gpu::Device& device, std::string lacking = "")
      : device_(device), lacking_(std::move(lacking)) {}
  /// Whether the program has kernels that lack it: built with WEFT_BENCH_LACKING, or compiled from a folder.
  static bool can_lack(const std::string& constant);
  /// @param module  path below shaders/, "passes/integrate.comp"
  /// @param name    for messages and debuggers
  std::shared_ptr<const gpu::ComputePipeline> get(const std::string& module, const std::string& name,
                                                  const std::vector<std::uint32_t>& constants);
  std::size_t count() const {
    const std::lock_guard lock(mutex_);
    return pipelines_.size();
  }

 private:
  using Key = std::pair<std::string, std::vector<std::uint32_t>>;
  std::string built(const std::string& module) const;
  gpu::Device& device_;
  std::string lacking_;
  mutable std::mutex mutex_;
  std::map<Key, std::shared_ptr<const gpu::ComputePipeline>> pipelines_;
};

}  // namespace weft
