// Notes are for --verbose; the bar moves from point to point.
#include "cli/study_watch.h"

#include <fmt/format.h>

#include "cli/interrupt.h"
#include "cli/setup.h"

namespace weft::cli {

study::Watch StudyWatch::watch() {
  return {.stop = [] { return interrupted(); },
          .note =
              [this](const std::string& text) {
                if (options_.verbose) note(options_, text);
              },
          .progress =
              [this](std::size_t done, std::size_t total) {
                if (progress_) progress_->show(done, total);
              }};
}

study::Bench study_bench(const Options& o, gpu::Device* device) {
  if (device == nullptr) return study::Bench::without_device(o.on_native());
  return {.device = device,
          .label = device_label(device->info()),
          .pipelines = std::make_shared<GpuPipelines>(*device)};
}

}  // namespace weft::cli
