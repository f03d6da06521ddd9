// Reads numbers from the environment and refuses what is none.
#include "core/environment.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>

#include "core/error.h"
#include "core/text.h"

namespace weft {

std::optional<std::uint64_t> environment_number(const char* name, std::uint64_t least, std::uint64_t most) {
  const char* text = std::getenv(name);
  if (text == nullptr) return std::nullopt;
  std::uint64_t value = 0;
  const char* end = text + std::strlen(text);
  const auto [stopped, problem] = std::from_chars(text, end, value);
  if (problem == std::errc{} && stopped == end && value >= least && value <= most) return value;
  const bool is_open = most == std::numeric_limits<std::uint64_t>::max();
  const std::string rule =
      is_open ? fmt::format("of at least {}", least) : fmt::format("from {} to {}", least, most);
  throw error(
      Exit::usage,
      "The environment variable {} is {}; it must be a whole number {} (for example {}={}, or unset it)",
      name, in_quotes(text, 80), rule, name, std::max<std::uint64_t>(least, 1));
}

}  // namespace weft
