// On Linux a thread is a process to setpriority(), and /proc/self/task lists them.
#include "viewer/thread_order.h"

#include <sys/resource.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <string>
#include <system_error>

namespace weft {

std::vector<int> threads_now() {
  std::vector<int> threads;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task", none)) {
    const std::string name = entry.path().filename().string();
    int id = 0;
    if (std::from_chars(name.data(), name.data() + name.size(), id).ec == std::errc{}) threads.push_back(id);
  }
  std::ranges::sort(threads);
  return threads;
}

int put_behind(const std::vector<int>& before) {
  int count = 0;
  for (const int thread : threads_now()) {
    const bool old = std::ranges::binary_search(before, thread);
    if (!old && setpriority(PRIO_PROCESS, static_cast<id_t>(thread), kBehindNice) == 0) ++count;
  }
  return count;
}

}  // namespace weft
