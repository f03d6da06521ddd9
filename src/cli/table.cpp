// Prints tables. Widths count characters, not bytes, so that µ and · do not shift a column.
#include "cli/table.h"

#include <algorithm>
#include <cstdio>

#include "core/error.h"

namespace weft::cli {
namespace {

using Json = nlohmann::ordered_json;

std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

std::string human_cell(const Json& cell) {
  if (cell.is_null()) return "-";
  if (cell.is_string()) return cell.get<std::string>();
  if (cell.is_boolean()) return cell.get<bool>() ? "yes" : "no";
  if (cell.is_number_float()) return fmt::format("{:.6g}", cell.get<double>());
  return cell.dump();
}

std::string aligned(const Table& table) {
  std::vector<std::vector<std::string>> lines(1);
  for (std::string name : table.columns) {
    std::replace(name.begin(), name.end(), '_', ' ');
    lines[0].push_back(name);
  }
  for (const auto& row : table.rows) {
    auto& line = lines.emplace_back();
    for (const Json& cell : row) line.push_back(human_cell(cell));
  }
  std::vector<std::size_t> widths(table.columns.size(), 0);
  for (const auto& line : lines)
    for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], width_of(line[c]));
  std::string text;
  for (const auto& line : lines) {
    std::string shown;
    for (std::size_t c = 0; c < line.size(); ++c)
      shown += line[c] + std::string(widths[c] - width_of(line[c]) + 2, ' ');
    text += shown.substr(0, shown.find_last_not_of(' ') + 1) + '\n';
  }
  return text;
}

std::string csv(const Table& table) {
  std::string text = fmt::format("{}\n", fmt::join(table.columns, ","));
  for (const auto& row : table.rows) {
    std::vector<std::string> cells;
    for (const Json& cell : row) cells.push_back(csv_cell(cell));
    text += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return text;
}

std::string json(const Table& table) {
  Json list = Json::array();
  for (const auto& row : table.rows) {
    Json item;
    for (std::size_t c = 0; c < row.size(); ++c) item[table.columns[c]] = row[c];
    list.push_back(std::move(item));
  }
  return list.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace

std::string csv_cell(const Json& cell) {
  if (cell.is_null()) return "";
  const std::string text = cell.is_string() ? cell.get<std::string>() : cell.dump();
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char letter : text) quoted += letter == '"' ? std::string("\"\"") : std::string(1, letter);
  return quoted + '"';
}

std::string to_text(const Table& table, Format format) {
  switch (format) {
    case Format::json: return json(table);
    case Format::csv: return csv(table);
    case Format::human: break;
  }
  return aligned(table);
}

void print_result(const std::string& text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (!written || std::fflush(stdout) != 0)
    throw Error(Exit::io, "stdout: the result cannot be written; is the disk full or the pipe closed?");
}

}  // namespace weft::cli
