// What a study tells while it runs: a note or the progress bar on stderr. Shared by `study` and by the
// commands that choose a setting from one.
#pragma once
#include <memory>
#include <string>

#include "cli/options.h"
#include "cli/progress.h"
#include "gpu/device.h"
#include "study/study.h"

namespace weft::cli {

class StudyWatch {
 public:
  StudyWatch(const Options& options, const std::string& title)
      : options_(options), progress_(std::make_unique<Progress>(title, options.quiet)) {}
  study::Watch watch();
  void finish() { progress_.reset(); }  ///< wipes the bar

 private:
  const Options& options_;
  std::unique_ptr<Progress> progress_;
};

/// Where settings run: on the device, or without one on native or the reference, as the options say.
study::Bench study_bench(const Options&, gpu::Device* device);

}  // namespace weft::cli
