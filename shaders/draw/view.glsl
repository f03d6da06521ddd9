// The view block, for every draw shader.
#extension GL_EXT_scalar_block_layout : require
#include "view.h"

layout(scalar, set = 0, binding = 0) uniform ViewBlock { View view; };
