// A quick study of the scene in a thread and on a device object of its own, so that the window goes on
// meanwhile.
#pragma once
#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "scene/scene.h"
#include "study/study.h"

namespace weft {

/// Where a study is.
struct StudyProgress {
  std::string doing;
  std::size_t done = 0, total = 0;  ///< settings measured; total 0: the reference is being computed
  double elapsed_s = 0.0;
};

class StudyRun {
 public:
  /// Starts at once. What is finished is kept in the cache folder, also of a study that is cancelled.
  /// @param device_uuid  empty: on the CPU
  /// @param native       on the CPU: its vector units; else the reference
  StudyRun(std::string device_uuid, bool native, Scene scene, double time_s);
  /// Cancels and waits, for the rest of one simulated frame.
  ~StudyRun();
  StudyRun(const StudyRun&) = delete;
  StudyRun& operator=(const StudyRun&) = delete;

  void cancel() { stop_ = true; }
  bool finished() const { return finished_; }
  StudyProgress progress() const;
  /// Once finished: why there is no study; empty when there is one, in the cache folder.
  std::string failure() const;

 private:
  void work();

  std::string device_uuid_;
  bool native_;
  Scene scene_;
  double time_s_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  mutable std::mutex mutex_;  // of the next three
  StudyProgress progress_;
  std::string failure_;
  std::atomic<bool> stop_ = false, finished_ = false;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace weft
