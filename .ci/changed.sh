#!/usr/bin/env bash
# Prints the files that changed, one a line, relative to the repository's root.
#   changed.sh SINCE [PATH...]     SINCE: a commit, or "" for the merge base with origin's main
# branch. Where that is this very commit, it is the one 20 commits before.
# A C++ file does not count where nothing but its comments, its place or its includes changed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
since=$1
shift
if [[ -z $since ]]; then
  since=$(git merge-base HEAD origin/HEAD 2>/dev/null ||
    git merge-base HEAD origin/main 2>/dev/null || true)
  if [[ -z $since || $since == "$(git rev-parse HEAD)" ]]; then
    since=$(git rev-list --first-parent --skip=20 -n 1 HEAD)
    [[ -n $since ]] || since=$(git rev-list --max-parents=0 HEAD | tail -1)
  fi
fi
code() {
  grep -v '^#include "' | g++ -fpreprocessed -dD -E -P -w -x c++ - 2>/dev/null |
    tr -s ' \t\n' ' '
}
{
  git diff --name-status -M --diff-filter=d "$since" -- "$@"
  git ls-files --others --exclude-standard -- "$@" | sed 's/^/A\t/'
} | sort -u | while IFS=$'\t' read -r _ old new; do
  new=${new:-$old}
  if [[ $new == *.h || $new == *.cpp ]] && git cat-file -e "$since:$old" 2>/dev/null; then
    ! cmp -s <(git show "$since:$old" | code) <(code <"$new") || continue
  fi
  echo "$new"
done
