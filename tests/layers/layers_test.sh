#!/usr/bin/env bash
# Tests the layer check itself: a tree that keeps the layers passes, and each kind of breach is found.
set -euo pipefail
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT

failures=0
# expect 0|1 FILE INCLUDE: the check's verdict on a tree with this one file.
expect() {
  local verdict=0
  rm -rf "$tree/src" "$tree/shaders"
  mkdir -p "$tree/src" "$tree/shaders" "$tree/$(dirname "$2")"
  echo "#include $3" >"$tree/$2"
  "$here/layers.sh" "$tree" >/dev/null || verdict=1
  [ "$verdict" -eq "$1" ] || { echo "$2 with #include $3: verdict $verdict, expected $1"; failures=$((failures + 1)); }
}

expect 0 src/passes/a.cpp '"model/model.h"'
expect 0 src/sim/a.cpp '"gpu/device.h"'
expect 0 src/gpu/a.cpp '<vulkan/vulkan.h>'
expect 0 src/cli/a.cpp '"viewer/viewer.h"'
expect 0 shaders/passes/a.comp '"../shared/pass.glsl"'
expect 1 src/model/a.cpp '"passes/pass.h"'
expect 1 src/scene/a.h '"model/model.h"'
expect 1 src/gpu/a.cpp '"shared/buffers.h"'
expect 1 src/gpu/a.cpp '"plan/plan.h"'
expect 1 src/core/a.cpp '<vulkan/vulkan.h>'
expect 1 src/plan/a.cpp '"gpu/device.h"'
expect 1 src/render/a.cpp '"study/study.h"'
expect 1 src/viewer/a.cpp '"cli/command.h"'
expect 1 src/sim/a.cpp '"../gpu/device.h"'
expect 1 src/elsewhere/a.cpp '"core/error.h"'
expect 1 shaders/passes/a.comp '"../draw/light.glsl"'
[ "$failures" -eq 0 ]
