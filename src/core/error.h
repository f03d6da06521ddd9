// Errors as the user meets them: every one carries the exit code the program documents.
#pragma once
#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace weft {

/// The documented exit codes of `weft` (docs/cli.md).
enum class Exit : int {
  ok = 0,
  internal = 1,
  usage = 2,      ///< usage, or a bad scene
  no_device = 3,  ///< no suitable device
  diverged = 4,   ///< the simulation left the finite numbers
  tolerance = 5,  ///< a comparison is over its tolerance
  io = 6,         ///< input or output failed
  skipped = 77,
  interrupted = 130,
};

/// A failure with a message for a person: place, value, rule, cure. Caught once, in main.
class Error : public std::runtime_error {
 public:
  Error(Exit code, const std::string& message) : std::runtime_error(message), code_(code) {}
  Exit code() const { return code_; }

 private:
  Exit code_;
};

/// Builds the message with fmt: `throw error(Exit::usage, "{}:{}: …", file, line)`.
template <class... Args>
[[nodiscard]] Error error(Exit code, fmt::format_string<Args...> format, Args&&... args) {
  return Error(code, fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace weft

/// A broken promise of our own code; checked in every build but release.
#ifdef NDEBUG
#define WEFT_ASSERT(condition) ((void)0)
#else
#define WEFT_ASSERT(condition)                               \
  ((condition) ? (void)0                                     \
               : throw ::weft::Error(::weft::Exit::internal, \
                                     fmt::format("{}:{}: {}", __FILE__, __LINE__, #condition)))
#endif
