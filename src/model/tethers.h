// Long-range attachments: which pinned particle is the nearest on the flat cloth, for every other.
#pragma once
#include "model/model.h"

namespace weft {

/// Only pins that never let go count. Of equally near ones it is that with the smaller column difference,
/// then the left one.
/// @param slack  that a tether may be longer than its length on the flat cloth, relative
/// @throws Error(Exit::usage) when nothing is pinned for good
std::vector<Tether> find_tethers(const Model& model, double slack);

}  // namespace weft
