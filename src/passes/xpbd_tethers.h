// The table of tethers that devices read.
#pragma once
#include <vector>

#include "model/model.h"
#include "shared/params.h"

namespace weft {

/// The buffer tethers: reaches in double, rounded once.
template <class T>
std::vector<shared::TetherOf<T>> make_tethers(const Model& model) {
  std::vector<shared::TetherOf<T>> table;
  table.reserve(model.tethers.size());
  for (const Tether& tether : model.tethers) table.push_back({tether.anchor, static_cast<T>(tether.reach_m)});
  return table;
}

}  // namespace weft
