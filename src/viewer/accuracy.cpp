// Files are read when the cloth becomes another one, and when a study ends.
#include "viewer/accuracy.h"

#include "study/kept_studies.h"

namespace weft {

void Accuracy::follow(RunningScene& running) {
  if (run_ && run_->finished()) {
    failure_ = run_->failure();
    run_.reset();
    if (resume_) running.set_paused(false);
    look_again_ = true;
  }
  find_study(running);
  setting_ = setting_of(running.scene(), running.simulation().plan().substeps);
  watch_.follow(running);
}

void Accuracy::find_study(const RunningScene& running) {
  if (!look_again_ && running.shown_version() == shown_version_) return;
  label_ = running.bench().label;
  shown_version_ = running.shown_version();
  const std::string folder = study::kept_folder(running.scene(), label_).string();
  if (!look_again_ && folder == folder_) return;  // only the setting changed
  look_again_ = false;
  folder_ = folder;
  nx_ = running.scene().cloth.resolution;
  study_ = study::kept_study(running.scene(), label_, {});
  points_ = study_ ? study_->promises_at(nx_) : std::vector<study::Point>{};
  answered_ = {};  // the wish is asked anew of another cloth
  choice_ = {};
  applied_ = false;
}

std::optional<study::Setting> Accuracy::wanted() {
  if (wish_ == answered_) {
    const bool runs = choice_.point && choice_.point->setting == setting_;
    if (applied_ && !runs) wish_.kind = WishKind::by_hand;  // what somebody changes by hand is theirs
    applied_ = runs;
    if (wish_.kind != answered_.kind) choice_ = {};
    answered_ = wish_;
    return {};
  }
  answered_ = wish_;
  choice_ = study_ ? choose_setting(*study_, nx_, wish_) : SettingChoice{};
  applied_ = choice_.point && choice_.point->setting == setting_;
  if (!choice_.point || applied_) return {};
  return choice_.point->setting;
}

void Accuracy::start_study(RunningScene& running) {
  failure_.clear();
  resume_ = !running.paused();
  running.set_paused(true);
  const study::Bench bench = running.bench();
  const std::string uuid = bench.device != nullptr ? bench.device->info().uuid : "";
  run_ = std::make_unique<StudyRun>(uuid, bench.native, running.scene(), kStudyTime_s);
}

void Accuracy::cancel_study() {
  if (run_) run_->cancel();
}

std::optional<double> Accuracy::measured_error_m() const {
  return study::measured_error_m(points_, setting_);
}

}  // namespace weft
