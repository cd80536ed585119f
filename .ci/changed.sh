#!/usr/bin/env bash
# Prints the files that changed, one a line, relative to the repository's root.
#   changed.sh SINCE [PATH...]     SINCE: a commit, or "" for the merge base with origin's main
# branch. Where that is this very commit, it is the one 20 commits before.
# A C++ file whose comments alone changed does not count.
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
code() { g++-12 -fpreprocessed -dD -E -P -w -x c++ - 2>/dev/null | tr -s ' \t\n' ' '; }
{
  git diff --name-only --diff-filter=d "$since" -- "$@"
  git ls-files --others --exclude-standard -- "$@"
} | sort -u | while IFS= read -r file; do
  if [[ $file == *.h || $file == *.cpp ]] && git cat-file -e "$since:$file" 2>/dev/null; then
    ! cmp -s <(git show "$since:$file" | code) <(code <"$file") || continue
  fi
  echo "$file"
done
