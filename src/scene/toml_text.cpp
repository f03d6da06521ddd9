// TOML text: reading it from a file, and parsing it behind a check that the parser is safe with it.
#include <algorithm>

#include "core/error.h"
#include "core/file.h"
#include "core/text.h"
#include "scene/settings.h"

namespace weft {
namespace {

bool is_key_start(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
         c == '"' || c == '\'';
}

/// Names the place, shows the line as it stands there, and says the rule and how lines are written.
Error not_toml(std::string_view text, std::string_view name, int line, std::string_view rule) {
  for (int k = 1; k < line; ++k) text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
  const std::string_view shown = text.substr(0, text.find_first_of("\r\n"));
  return error(Exit::usage,
               "{}:{}: {} is not TOML: {}; write [section], key = 1.5, key = \"text\" or key = [1, 2, 3]",
               name, line, in_quotes(shown, 60), rule);
}

/// Walks over TOML text outside of strings and comments. toml++ 3.3 assumes, without looking, that what
/// stands there is ASCII, that a name follows a section's '[', and that no '}' ends an array; in its release
/// build a file that breaks this is undefined behaviour (found by fuzzing). The walk refuses exactly such
/// files. Only what comes before the first mistake of syntax matters, since the parser stops there.
class Walk {
 public:
  Walk(std::string_view text, const std::string& name) : text_(text), name_(name) {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;  // a byte order mark
  }

  void run() {
    bool line_is_blank = true;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '[' && line_is_blank && open_.empty()) check_header();
      if (static_cast<unsigned char>(c) >= 0x80)
        refuse("only text in quotes and comments may hold other letters than ASCII");
      line_is_blank = c == '\n' || (line_is_blank && (c == ' ' || c == '\t'));
      line_ += c == '\n' ? 1 : 0;
      match_bracket(c);
      if (c == '#')
        at_ = std::min(text_.find('\n', at_), text_.size());
      else if (c == '"' || c == '\'')
        skip_string(c);
      else
        ++at_;
    }
  }

 private:
  [[noreturn]] void refuse(std::string_view rule) const { throw not_toml(text_, name_, line_, rule); }

  void match_bracket(char c) {
    if (c == '[' || c == '{') open_ += c;
    if (c != ']' && c != '}') return;
    const char opening = c == ']' ? '[' : '{';
    if (open_.empty() || open_.back() != opening) refuse(fmt::format("a '{}' closes no '{}'", c, opening));
    open_.pop_back();
  }

  void check_header() const {
    const std::size_t brackets = text_.substr(at_).starts_with("[[") ? 2 : 1;
    const std::size_t first = text_.find_first_not_of(" \t", at_ + brackets);
    if (first == std::string_view::npos || !is_key_start(text_[first]))
      refuse("a section's name must follow its bracket, as in [cloth]");
  }

  /// Leaves `at_` behind the closing quotes, or at the end of the line or text that lacks them.
  void skip_string(char quote) {
    const std::string three(3, quote);
    const bool is_long = text_.substr(at_).starts_with(three);
    at_ += is_long ? 3 : 1;
    for (; at_ < text_.size(); ++at_) {
      if (text_[at_] == '\n' && !is_long) return;
      line_ += text_[at_] == '\n' ? 1 : 0;
      if (text_[at_] == '\\' && quote == '"') {
        ++at_;
        line_ += at_ < text_.size() && text_[at_] == '\n' ? 1 : 0;
      } else if (!is_long && text_[at_] == quote) {
        ++at_;
        return;
      } else if (is_long && text_.substr(at_).starts_with(three)) {
        const std::size_t end = std::min(text_.find_first_not_of(quote, at_), text_.size());
        at_ = std::min(end, at_ + 5);  // up to two quotes before the closing three belong to the string
        return;
      }
    }
    at_ = std::min(at_, text_.size());
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
  int line_ = 1;
  std::string open_;  ///< brackets not yet closed, innermost last
};

}  // namespace

toml::table parse_toml(std::string_view text, const std::string& name) {
  Walk(text, name).run();
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& mistake) {
    throw not_toml(text, name, static_cast<int>(mistake.source().begin.line), mistake.description());
  }
}

std::vector<TableEntry> in_file_order(const toml::table& table) {
  std::vector<TableEntry> entries;
  for (const auto& [key, node] : table) entries.emplace_back(&key, &node);
  std::stable_sort(entries.begin(), entries.end(), [](const TableEntry& a, const TableEntry& b) {
    return a.first->source().begin < b.first->source().begin;
  });
  return entries;
}

std::string read_toml_file(const std::filesystem::path& file) {
  constexpr std::size_t kLongest =
      1 << 20;  // a scene of a thousand pins has 50 kB; more is another kind of file
  try {
    return read_file(file, kLongest);
  } catch (const Error& failure) {
    throw error(Exit::usage, "{}; a scene is a TOML file of at most 1 MiB", failure.what());
  }
}

}  // namespace weft
