// Compute pipelines by module and constants.
#include "sim/gpu_pipelines.h"

#include "gpu/shader.h"

namespace weft {
namespace {

constexpr std::string_view kLacks = "+WEFT_LACKS_";

}  // namespace

bool GpuPipelines::can_lack(const std::string& constant) {
  return gpu::has_spirv("passes/integrate.comp" + std::string(kLacks) + constant);
}

/// The module that stands for one of `integrate` in a program that lacks an effect; any other is as it is.
std::string GpuPipelines::built(const std::string& module) const {
  const bool kernel = module.starts_with("passes/integrate") && module.find('+') == std::string::npos;
  return lacking_.empty() || !kernel ? module : module + std::string(kLacks) + lacking_;
}

std::shared_ptr<const gpu::ComputePipeline> GpuPipelines::get(const std::string& module,
                                                              const std::string& name,
                                                              const std::vector<std::uint32_t>& constants) {
  const Key key{module, constants};
  {
    const std::lock_guard lock(mutex_);
    if (const auto known = pipelines_.find(key); known != pipelines_.end()) return known->second;
  }
  // Compiling may take seconds: nobody else waits for it. Where two compile the same, the first is kept.
  auto made =
      std::make_shared<const gpu::ComputePipeline>(device_, name, gpu::load_spirv(built(module)), constants);
  const std::lock_guard lock(mutex_);
  return pipelines_.try_emplace(key, std::move(made)).first->second;
}

}  // namespace weft
