#!/usr/bin/env bash
# clang-tidy over the sources that changed; any finding is an error.
#   tidy.sh BUILD JOBS [SINCE]   BUILD: a folder with compile_commands.json; SINCE: a commit
# Without SINCE: since the merge base with origin's main branch, or, where that is this very commit,
# since 20 commits ago. For a header that changed the source of the same name is looked at.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=$1
jobs=$2
since=${3:-}

if [[ -z $since ]]; then
  since=$(git merge-base HEAD origin/HEAD 2>/dev/null ||
    git merge-base HEAD origin/main 2>/dev/null || true)
  if [[ -z $since || $since == "$(git rev-parse HEAD)" ]]; then
    since=$(git rev-parse --verify --quiet HEAD~20 || git rev-list --max-parents=0 HEAD | tail -n 1)
  fi
fi

# Of what is compiled at all: what the build does not know cannot be looked at.
known=$(grep -o '"file": "[^"]*"' "$build/compile_commands.json" | cut -d'"' -f4 | sort -u)
mapfile -t sources < <(
  git diff --name-only --diff-filter=d "$since" -- '*.h' '*.cpp' | sed 's/[.]h$/.cpp/' | sort -u |
    while IFS= read -r file; do grep -xF "$PWD/$file" <<<"$known" || true; done
)
echo "tidy: ${#sources[@]} sources that changed since $(git rev-parse --short "$since")"
[[ ${#sources[@]} == 0 ]] && exit 0
printf '%s\0' "${sources[@]}" | xargs -0 -n 1 -P "$jobs" clang-tidy-19 --quiet -p "$build"
