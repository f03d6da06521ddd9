// Stretch and energy over simulated time as two small curves.
#pragma once
#include "study/live.h"

namespace weft {

/// Draws both side by side at the cursor, together `width` [screen units] wide.
void draw_history(const study::History& history, float width);

}  // namespace weft
