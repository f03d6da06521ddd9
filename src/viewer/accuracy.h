// The accuracy panel's matter: the study of the cloth on screen, the wish for an error or a frame time, what
// is seen of the running cloth. It exists only while the panel is open.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "viewer/live_watch.h"
#include "viewer/setting_choice.h"
#include "viewer/study_run.h"

namespace weft {

class Accuracy {
 public:
  /// Over this time a study that is started here follows the cloth.
  static constexpr double kStudyTime_s = 0.5;

  Accuracy() = default;
  /// Cancels a study that runs.
  ~Accuracy() = default;
  Accuracy(const Accuracy&) = delete;
  Accuracy& operator=(const Accuracy&) = delete;

  /// Once a picture, before the panel is drawn.
  void follow(RunningScene& running);
  /// The setting that the wish asks for, when the wish or the study is new and another one runs.
  std::optional<study::Setting> wanted();

  /// Starts a quick study of the scene; the running cloth rests meanwhile, so that the times are right.
  void start_study(RunningScene& running);
  void cancel_study();
  const StudyRun* study_run() const { return run_.get(); }
  const std::string& study_failure() const { return failure_; }

  /// The study of this cloth on this device, at this resolution; nullptr when none is kept.
  const study::Study* study() const { return study_ ? &*study_ : nullptr; }
  SettingWish& wish() { return wish_; }
  const SettingWish& wish() const { return wish_; }
  const SettingChoice& choice() const { return choice_; }
  const LiveWatch& watch() const { return watch_; }
  const study::Setting& setting() const { return setting_; }
  /// The running setting's error as the study has it [m].
  std::optional<double> measured_error_m() const;
  std::uint32_t nx() const { return nx_; }

 private:
  void find_study(const RunningScene& running);

  std::string label_;  // of what the study is of
  LiveWatch watch_;
  std::optional<study::Study> study_;
  std::vector<study::Point> points_;
  std::unique_ptr<StudyRun> run_;
  bool resume_ = false;  // the cloth moved when the study began
  std::string failure_, folder_;
  SettingWish wish_, answered_;
  SettingChoice choice_;
  study::Setting setting_;
  std::uint64_t shown_version_ = 0;
  std::uint32_t nx_ = 0;
  bool look_again_ = true;
  bool applied_ = false;  // the chosen setting has run
};

}  // namespace weft
