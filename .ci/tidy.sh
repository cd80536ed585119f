#!/usr/bin/env bash
# clang-tidy over the sources that changed; any finding is an error.
#   tidy.sh BUILD JOBS [SINCE]   BUILD: a folder with compile_commands.json; SINCE: a commit
# Without SINCE: since the merge base with origin's main branch, or, where that is this very commit,
# what the last 20 commits changed. For a header that changed the source of the same name is looked
# at.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=$1
jobs=$2
since=${3:-}

if [[ -z $since ]]; then
  since=$(git merge-base HEAD origin/HEAD 2>/dev/null ||
    git merge-base HEAD origin/main 2>/dev/null || true)
  [[ $since == "$(git rev-parse HEAD)" ]] && since=
fi
changed() {
  if [[ -n $since ]]; then
    git diff --name-only --diff-filter=d "$since" -- '*.h' '*.cpp'
  else
    git log --no-merges -n 20 --name-only --format= -- '*.h' '*.cpp'
  fi | sed 's/[.]h$/.cpp/' | sort -u
}

# Of what is compiled at all: what the build does not know cannot be looked at.
known=$(grep -o '"file": "[^"]*"' "$build/compile_commands.json" | cut -d'"' -f4 | sort -u)
mapfile -t sources < <(
  changed | while IFS= read -r file; do grep -xF "$PWD/$file" <<<"$known" || true; done
)
echo "tidy: ${#sources[@]} sources, of what changed since ${since:-20 commits ago}"
[[ ${#sources[@]} == 0 ]] && exit 0
printf '%s\0' "${sources[@]}" | xargs -0 -n 1 -P "$jobs" clang-tidy-19 --quiet -p "$build"
