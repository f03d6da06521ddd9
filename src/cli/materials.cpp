// `weft materials`: the presets that --material and material.preset take, with their constants.
#include "cli/command.h"
#include "cli/table.h"
#include "scene/reader.h"

namespace weft::cli {
namespace {

/// The preset's constants, read by the scene reader itself so that both always agree.
MaterialSection read_preset(const std::string& name) {
  return parse_scene("[cloth]\n[material]\npreset = \"" + name + "\"\n", name).scene.material;
}

Exit run_materials(const Options& o) {
  Table table{{"name", "title", "density_kg_m2", "membrane_warp_n_m", "membrane_weft_n_m", "shear_n_m",
               "flex", "bend_warp_n_m", "bend_weft_n_m", "damping_s", "damping_ratio_max", "file"},
              {}};
  for (const AssetInfo& asset : list_materials()) {
    const MaterialSection m = read_preset(asset.name);
    table.rows.push_back({asset.name, asset.title, m.density_kg_m2, m.membrane_warp(), m.membrane_weft(),
                          m.shear(), m.flex, m.bend_warp(), m.bend_weft(), m.damping_s, m.damping_ratio_max,
                          asset.file.string()});
  }
  print_result(to_text(table, o.format));
  return Exit::ok;
}

}  // namespace

const Command materials_command{"materials",
                                "lists the materials and their constants",
                                "  weft materials\n  weft simulate 1 --material denim --time 1",
                                [](CLI::App&, Options&) {},
                                run_materials,
                                false};

}  // namespace weft::cli
