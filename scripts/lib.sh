# shellcheck shell=bash
# Shared by the scripts of this folder: the repository's root, messages, and running a step quietly.
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"

say() { printf '%s\n' "$*" >&2; }

die() {
  local code=$1
  shift
  say "error: $*"
  exit "$code"
}

# Every file that belongs to the project, NUL-separated, relative to the root; a tarball has no git.
project_files() {
  if git -c safe.directory="$root" -C "$root" rev-parse --git-dir >/dev/null 2>&1; then
    git -c safe.directory="$root" -C "$root" ls-files -z --cached --others --exclude-standard -- "$@" |
      while IFS= read -r -d '' file; do [ ! -f "$root/$file" ] || printf '%s\0' "$file"; done
  else
    (cd "$root" && find . \( -name build -o -name out -o -name .git \) -prune -o -type f -print0 |
      sed -z 's|^\./||' | filter_by_globs "$@")
  fi
}

# Reads NUL-separated paths and keeps those whose name matches one of the patterns; none given: all.
filter_by_globs() {
  local file glob
  while IFS= read -r -d '' file; do
    [ $# -gt 0 ] || printf '%s\0' "$file"
    for glob in "$@"; do
      # shellcheck disable=SC2053  # the pattern is meant as one
      if [[ $file == $glob ]]; then
        printf '%s\0' "$file"
        break
      fi
    done
  done
}

# quietly LOG WHAT COMMAND...: runs with the output in LOG; shows its end when the command fails.
# On a terminal, or with VERBOSE=1, the output is shown as it comes.
quietly() {
  local log=$1 what=$2 start=$SECONDS status=0
  shift 2
  mkdir -p "$(dirname "$log")"
  if [ -t 2 ] || [ "${VERBOSE:-0}" = 1 ]; then
    "$@" 2>&1 | tee "$log" >&2 || status=${PIPESTATUS[0]}
  else
    "$@" >"$log" 2>&1 </dev/null || status=$?
    [ "$status" -eq 0 ] || tail -n 80 "$log" >&2
  fi
  [ "$status" -eq 0 ] || { say "$what failed (exit $status); all of its output: $log"; return "$status"; }
  say "$what: $((SECONDS - start)) s"
}
