// Writing lines, each whole at once.
#include "viewer/state_log.h"

#include "core/error.h"

namespace weft {

StateLog::StateLog(const std::filesystem::path& file) {
  if (file.empty()) return;
  file_.open(file, std::ios::trunc);
  if (!file_)
    throw error(Exit::io, "{}: cannot be written; choose another file for the viewer's log", file.string());
}

bool StateLog::state(const std::string& settings, const std::string& figures) {
  const auto now = std::chrono::steady_clock::now();
  if (!on() || (settings == settings_ && now < next_)) return false;
  file_ << "state " << settings << ' ' << figures << std::endl;
  settings_ = settings;
  next_ = now + std::chrono::milliseconds(200);
  return true;
}

void StateLog::event(const std::string& text) {
  if (on()) file_ << "event " << text << std::endl;
}

}  // namespace weft
