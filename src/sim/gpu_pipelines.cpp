// Compute pipelines by module and constants.
#include "sim/gpu_pipelines.h"

#include "gpu/shader.h"

namespace weft {

std::shared_ptr<const gpu::ComputePipeline> GpuPipelines::get(const std::string& module,
                                                              const std::string& name,
                                                              const std::vector<std::uint32_t>& constants) {
  std::shared_ptr<const gpu::ComputePipeline>& pipeline = pipelines_[{module, constants}];
  if (!pipeline)
    pipeline =
        std::make_shared<const gpu::ComputePipeline>(device_, name, gpu::load_spirv(module), constants);
  return pipeline;
}

}  // namespace weft
