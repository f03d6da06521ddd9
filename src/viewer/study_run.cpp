// A device object serves one thread, so the study opens its own.
#include "viewer/study_run.h"

#include <memory>

#include "core/error.h"
#include "study/kept_studies.h"

namespace weft {

StudyRun::StudyRun(std::string device_uuid, bool native, Scene scene, double time_s)
    : device_uuid_(std::move(device_uuid)), native_(native), scene_(std::move(scene)), time_s_(time_s) {
  progress_.doing = "starting";
  thread_ = std::thread([this] { work(); });
}

StudyRun::~StudyRun() {
  cancel();
  thread_.join();
}

void StudyRun::work() {
  try {
    std::unique_ptr<gpu::Device> device;
    study::Bench bench = study::Bench::without_device(native_);
    if (!device_uuid_.empty()) {
      device = std::make_unique<gpu::Device>(gpu::DeviceOptions{.choice = device_uuid_});
      bench = {.device = device.get(),
               .label = device->info().label(),
               .pipelines = std::make_shared<GpuPipelines>(*device)};
    }
    const study::Watch watch{.stop = [this] { return stop_.load(); },
                             .note =
                                 [this](const std::string& text) {
                                   const std::lock_guard lock(mutex_);
                                   progress_.doing = text;
                                 },
                             .progress =
                                 [this](std::size_t done, std::size_t total) {
                                   const std::lock_guard lock(mutex_);
                                   progress_.done = done;
                                   progress_.total = total;
                                 }};
    study::study_for_choosing(bench, scene_, time_s_, watch);
  } catch (const std::exception& reason) {  // a thread must not throw; the panel says it
    const std::lock_guard lock(mutex_);
    failure_ = stop_ ? "cancelled; the points measured so far are kept" : reason.what();
  }
  finished_ = true;
}

StudyProgress StudyRun::progress() const {
  const std::lock_guard lock(mutex_);
  StudyProgress now = progress_;
  now.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  return now;
}

std::string StudyRun::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

}  // namespace weft
