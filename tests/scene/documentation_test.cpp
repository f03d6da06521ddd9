// docs/scene-format.md names every parameter with the type, default, range and unit the program uses.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "core/file.h"
#include "core/text.h"
#include "scene/parameters.h"

namespace weft {
namespace {

std::string type_text(const Parameter& p) {
  if (p.kind == ParameterKind::vec2) return "two numbers";
  if (p.kind == ParameterKind::vec3) return "three numbers";
  if (p.kind == ParameterKind::word) return "word";
  if (p.kind == ParameterKind::keys) return "list of keys";
  const std::string number = p.kind == ParameterKind::integer ? "whole number" : "number";
  return p.words.empty() ? number : number + " or word";
}

std::string range_text(const Parameter& p) {
  std::string words;
  for (const char c : p.words) words += c == '|' ? std::string("`, `") : std::string(1, c);
  if (!words.empty()) words = "`" + words + "`";
  if (p.kind == ParameterKind::word) return words.empty() ? "any" : words;
  const std::string range = fmt::format("{} to {}", short_number(p.minimum), short_number(p.maximum));
  return words.empty() ? range : range + ", or " + words;
}

/// The row of the document's table that belongs to a parameter.
std::string document_row(const Parameter& p) {
  return fmt::format("| `{}` | {} | {} | {} | {} | {} |", p.key, type_text(p), default_text(p), range_text(p),
                     p.unit.empty() ? "–" : p.unit, p.about);
}

TEST(SceneDocument, NamesEveryParameterAsTheTableHasIt) {
  const std::string document = read_file(WEFT_SOURCE_DIR "/docs/scene-format.md");
  for (const Parameter& parameter : parameters())
    EXPECT_NE(document.find(document_row(parameter)), std::string::npos)
        << "docs/scene-format.md lacks this row, under " << parameter.section << ":\n"
        << document_row(parameter);
}

TEST(SceneDocument, HasAHeadingForEverySection) {
  const std::string document = read_file(WEFT_SOURCE_DIR "/docs/scene-format.md");
  for (const std::string_view section : section_names()) {
    const std::string heading =
        is_list_section(section) ? fmt::format("## `[[{}]]`", section) : fmt::format("## `[{}]`", section);
    EXPECT_NE(document.find(heading), std::string::npos) << heading;
  }
}

}  // namespace
}  // namespace weft
