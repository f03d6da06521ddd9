// The parameter table, put together from its parts in the order of docs/scene-format.md.
#include <vector>

#include "scene/parameter_rows.h"

namespace weft {

std::span<const Parameter> parameters() {
  using namespace parameter_access;
  static const std::vector<Parameter> table = [] {
    std::vector<Parameter> all;
    for (const auto rows : {cloth_rows(), outside_rows(), collider_rows(), run_rows()})
      all.insert(all.end(), rows.begin(), rows.end());
    return all;
  }();
  return table;
}

}  // namespace weft
