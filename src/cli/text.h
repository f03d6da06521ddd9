// Words and numbers as people type them: checked parsing of option values.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace weft::cli {

/// A finite number in [minimum, maximum], all of the text used.
/// @param option  place named in the message, for example "--time"
/// @param unit    shown with the rule, empty when the number has none
/// @param cure    an example that works, for example "--time 2.5"
/// @throws Error(Exit::usage) naming option, text, rule and cure
double parse_number(std::string_view option, std::string_view text, double minimum, double maximum,
                    std::string_view unit, std::string_view cure);

/// A whole number in [minimum, maximum]; otherwise as parse_number.
std::uint32_t parse_count(std::string_view option, std::string_view text, std::uint32_t minimum,
                          std::uint32_t maximum, std::string_view cure);

/// The place of `text` in `words`.
/// @throws Error(Exit::usage) listing the words and suggesting the nearest
std::size_t parse_word(std::string_view option, std::string_view text,
                       std::span<const std::string_view> words);

/// A TOML basic string with its quotes: whatever the text holds, it stays one string.
std::string toml_string(std::string_view text);

/// "; did you mean NEAREST?", or nothing when no known word is near.
std::string suggestion(std::string_view word, std::span<const std::string_view> known);

}  // namespace weft::cli
