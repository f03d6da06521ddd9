#!/usr/bin/env bash
# Holds every #include of src/ and shaders/ against the layers of docs/ARCHITECTURE.md: left never includes right.
#   shared → core → scene → model → passes → solvers → plan;  core → gpu;
#   {plan → native, gpu} → sim → {study, render} → {cli, viewer}
# Usage: tests/layers/layers.sh ROOT     prints file:line of each breach; exit 1 when there is one
set -euo pipefail
cd "$1"

# Whom each folder may include, besides itself. `shared` knows the cloth's buffers, so core and gpu may not.
declare -A may=(
  [shared]=""
  [core]=""
  [scene]="shared core"
  [model]="shared core scene"
  [passes]="shared core scene model"
  [solvers]="shared core scene model passes"
  [plan]="shared core scene model passes solvers"
  [native]="shared core scene model passes solvers plan"
  [gpu]="core"
  [sim]="shared core scene model passes solvers plan native gpu"
  [study]="shared core scene model passes solvers plan native gpu sim"
  [render]="shared draw core scene model passes solvers plan native gpu sim"
  [viewer]="shared draw core scene model passes solvers plan native gpu sim study render"
  [cli]="shared core scene model passes solvers plan native gpu sim study render viewer"
)
# Folders that may see Vulkan and the window.
vulkan=" gpu sim study render viewer cli "

breaches=0
breach() {
  echo "$1: $2"
  breaches=$((breaches + 1))
}

# check_include FILE:LINE FOLDER INCLUDED
check_include() {
  local place=$1 folder=$2 included=$3 target
  if [[ $included == \<* ]]; then
    if [[ $included =~ ^\<(vulkan|GLFW|imgui) && $vulkan != *" $folder "* ]]; then
      breach "$place" "$folder must not know $included"
    fi
    return
  fi
  included=${included//\"/}
  [[ $included != ../* || $folder == shaders ]] || breach "$place" "write \"folder/file.h\", not \"$included\""
  target=${included#../}
  case $target in
    */*) target=${target%%/*} ;;
    *) return ;;  # the same folder, or a header the build makes
  esac
  [ "$target" != "$folder" ] || return 0
  if [ "$folder" = shaders ]; then
    [ "$target" = shared ] || breach "$place" "a shader includes shared/ only, not $included"
    return
  fi
  [ -n "${may[$folder]+known}" ] || { breach "$place" "the folder $folder has no place in the layers"; return; }
  [[ " ${may[$folder]} " == *" $target "* ]] || breach "$place" "$folder must not include $included"
}

while IFS=: read -r file line text; do
  case $file in
    src/*) folder=${file#src/} folder=${folder%%/*} ;;
    shaders/shared/*) folder=shared ;;
    *) folder=shaders ;;
  esac
  if [[ $text =~ ^[[:space:]]*#[[:space:]]*include[[:space:]]+(\"[^\"]+\"|<[^>]+>) ]]; then
    check_include "$file:$line" "$folder" "${BASH_REMATCH[1]}"
  fi
done < <(grep -rn --include='*.h' --include='*.cpp' --include='*.glsl' --include='*.comp' --include='*.vert' \
  --include='*.frag' -E '^[[:space:]]*#[[:space:]]*include' src shaders)

[ "$breaches" -eq 0 ] || { echo "$breaches includes break the layers"; exit 1; }
