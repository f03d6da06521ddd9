// Checked parsing of option values. Locale plays no part: from_chars reads the same everywhere.
#include "cli/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/error.h"
#include "core/text.h"

namespace weft::cli {
namespace {

std::string number_rule(double minimum, double maximum, std::string_view unit) {
  const std::string range = std::isinf(maximum) ? "at least " + short_number(minimum)
                                                : short_number(minimum) + " to " + short_number(maximum);
  return unit.empty() ? range : fmt::format("{} {}", range, unit);
}

}  // namespace

double parse_number(std::string_view option, std::string_view text, double minimum, double maximum,
                    std::string_view unit, std::string_view cure) {
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [stopped, failure] = std::from_chars(text.data(), end, value);
  const bool number = failure == std::errc() && stopped == end && std::isfinite(value);
  if (number && value >= minimum && value <= maximum) return value;
  throw error(Exit::usage, "{} is {}; it must be a number, {} (for example {})", option, in_quotes(text),
              number_rule(minimum, maximum, unit), cure);
}

std::uint32_t parse_count(std::string_view option, std::string_view text, std::uint32_t minimum,
                          std::uint32_t maximum, std::string_view cure) {
  std::uint32_t value = 0;
  const char* end = text.data() + text.size();
  const auto [stopped, failure] = std::from_chars(text.data(), end, value);
  if (failure == std::errc() && stopped == end && value >= minimum && value <= maximum) return value;
  throw error(Exit::usage, "{} is {}; it must be a whole number, {} to {} (for example {})", option,
              in_quotes(text), minimum, maximum, cure);
}

std::size_t parse_word(std::string_view option, std::string_view text,
                       std::span<const std::string_view> words) {
  const auto found = std::find(words.begin(), words.end(), text);
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  throw error(Exit::usage, "{} is {}; it must be one of {}{}", option, in_quotes(text),
              fmt::join(words, ", "), suggestion(text, words));
}

std::string suggestion(std::string_view word, std::span<const std::string_view> known) {
  const std::string_view best = nearest_name(word, known);
  return best.empty() ? std::string() : fmt::format("; did you mean {}?", best);
}

std::string toml_string(std::string_view text) {
  std::string quoted = "\"";
  for (const char letter : text) {
    const auto byte = static_cast<unsigned char>(letter);
    if (letter == '"' || letter == '\\') {
      quoted += '\\';
      quoted += letter;
    } else if (byte < 0x20 || byte == 0x7f) {
      quoted += fmt::format("\\u{:04X}", byte);
    } else {
      quoted += letter;
    }
  }
  return quoted + '"';
}

}  // namespace weft::cli
