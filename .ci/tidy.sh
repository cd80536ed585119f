#!/usr/bin/env bash
# clang-tidy over the sources that changed; any finding is an error.
#   tidy.sh BUILD JOBS [SINCE]   BUILD: a folder with compile_commands.json; SINCE: as changed.sh's
# A header that changed stands for the source of the same name.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=$1
jobs=$2
since=${3:-}

# Only sources that the build compiles.
known=$(grep -o '"file": "[^"]*"' "$build/compile_commands.json" | cut -d'"' -f4 | sort -u)
mapfile -t sources < <(
  .ci/changed.sh "$since" '*.h' '*.cpp' | sed 's/[.]h$/.cpp/' | sort -u |
    while IFS= read -r file; do grep -xF "$PWD/$file" <<<"$known" || true; done
)
echo "tidy: ${#sources[@]} sources changed${since:+ since $since}"
[[ ${#sources[@]} == 0 ]] && exit 0
printf '%s\0' "${sources[@]}" | xargs -0 -n 1 -P "$jobs" clang-tidy-19 --quiet -p "$build"
