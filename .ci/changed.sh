#!/usr/bin/env bash
# Prints the files that changed, one a line, relative to the repository's root.
#   changed.sh SINCE [PATH...]     SINCE: a commit, or "" for the merge base with origin's main
# branch. Where that is this very commit, the last 20 commits count.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
since=$1
shift
if [[ -z $since ]]; then
  since=$(git merge-base HEAD origin/HEAD 2>/dev/null ||
    git merge-base HEAD origin/main 2>/dev/null || true)
  [[ $since == "$(git rev-parse HEAD)" ]] && since=
fi
{
  if [[ -n $since ]]; then
    git diff --name-only --diff-filter=d "$since" -- "$@"
  else
    git log --no-merges -n 20 --name-only --diff-filter=d --format= -- "$@"
    git diff --name-only --diff-filter=d HEAD -- "$@"
  fi
  git ls-files --others --exclude-standard -- "$@"
} | sort -u
