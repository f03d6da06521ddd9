// `weft scenes`: the scenes that ship, by number, name and title.
#include "cli/command.h"
#include "cli/table.h"
#include "scene/reader.h"

namespace weft::cli {
namespace {

Exit run_scenes(const Options& o) {
  Table table{{"number", "name", "title", "file"}, {}};
  int number = 0;
  for (const AssetInfo& asset : list_scenes())
    table.rows.push_back({++number, asset.name, asset.title, asset.file.string()});
  print_result(to_text(table, o.format));
  return Exit::ok;
}

}  // namespace

const Command scenes_command{"scenes", "lists the scenes", "  weft scenes\n  weft scenes --format json",
                             [](CLI::App&, Options&) {}, run_scenes};

}  // namespace weft::cli
