// `weft scenes`: the scenes that ship, by number, name and title.
#include "cli/command.h"
#include "cli/table.h"
#include "scene/reader.h"

namespace weft::cli {
namespace {

Exit run_scenes(const Options& o) {
  Table table{{"number", "name", "title", "file"}, {}};
  const std::size_t numbered = numbered_scenes().size();
  for (const AssetInfo& asset : list_scenes()) {
    const std::size_t number = table.rows.size() + 1;
    nlohmann::ordered_json shown = "";
    if (number <= numbered) shown = number;
    table.rows.push_back({shown, asset.name, asset.title, asset.file.string()});
  }
  print_result(to_text(table, o.format));
  return Exit::ok;
}

}  // namespace

const Command scenes_command{"scenes",
                             "lists the scenes",
                             "  weft scenes\n  weft scenes --format json",
                             [](CLI::App&, Options&) {},
                             run_scenes,
                             false};

}  // namespace weft::cli
