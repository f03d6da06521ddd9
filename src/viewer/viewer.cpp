// The viewer's one entry.
#include "viewer/viewer.h"

#include "core/error.h"
#include "gpu/shader.h"
#include "viewer/application.h"

namespace weft {

int run_viewer(const ViewerOptions& options) {
  if (!options.shader_dir.empty()) gpu::set_shader_dir(options.shader_dir);
  Application application(options);
  application.run();
  return static_cast<int>(Exit::ok);
}

}  // namespace weft
