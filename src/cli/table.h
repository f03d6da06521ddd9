// Results as people or programs read them: one table, printed aligned, as JSON or as CSV.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/options.h"

namespace weft::cli {

/// Rows of cells under named columns. Column names are the JSON keys and the CSV header.
struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<nlohmann::ordered_json>> rows;
};

/// Human: aligned columns. JSON: an array of objects. CSV: a header and RFC 4180 quoting.
std::string to_text(const Table&, Format);

/// One cell as CSV: strings quoted where they must be, floating-point numbers with 17 digits at most.
std::string csv_cell(const nlohmann::ordered_json& cell);

/// Writes to stdout and flushes.
/// @throws Error(Exit::io) when stdout cannot take it (a full disk, a closed pipe)
void print_result(const std::string& text);

}  // namespace weft::cli
