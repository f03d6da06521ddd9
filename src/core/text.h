// Words and numbers as messages show them: short, quoted, and with the nearest known name.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace weft {

/// A number in at most six significant digits, as %g writes it: 0.1, 1e-05, 300.
std::string short_number(double value);

/// Text in double quotes, control bytes replaced by '?', cut after `limit` bytes with "…".
std::string in_quotes(std::string_view text, std::size_t limit = 40);

/// Letters to insert, delete, change or swap with their neighbour to turn one word into the other, case
/// ignored.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The known name nearest to `word`, or empty when none is near enough to be a slip of the keyboard
/// (more than a third of its letters differ and neither begins with the other).
std::string_view nearest_name(std::string_view word, std::span<const std::string_view> known);

/// The text with the letters A to Z as a to z.
std::string in_lower_case(std::string_view text);

/// "1 substep", "2 substeps": a count of a thing whose plural adds an s.
std::string counted(std::uint64_t count, std::string_view thing);

/// "a, b and c".
std::string joined(std::span<const std::string_view> words);

}  // namespace weft
