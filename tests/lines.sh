#!/usr/bin/env bash
# No line of code or prose is over 100 columns. Exceptions are lines that cannot be broken: a
# table's row, a link, a word without blanks, an example of a protocol's message.
#   lines.sh [ROOT]   0 = none; 1 = each is named
set -euo pipefail
cd "${1:-$(dirname "${BASH_SOURCE[0]}")/..}"

long=$(
  git ls-files -z '*.h' '*.cpp' '*.c' '*.ts' '*.mjs' '*.css' '*.py' '*.sh' \
    '*.cmake' '*CMakeLists.txt' Makefile '*.md' '*.yaml' '.ci/*' '.packaging/*' \
    ':!tests/golden' ':!tests/bench/RESULTS.md' |
    LC_ALL=C.UTF-8 xargs -0 grep -nHP '^.{101,}$' |
    grep -vP '^[^:]+[.]md:\d+: *([|]|!?\[)' |           # tables, pictures, links
    grep -vP '^[^:]+:\d+:\S*\s*\S*\s*\S*$' |            # hardly a blank to break at
    grep -vP 'R"\w*\(|^[^:]+:\d+:\s*["{\[`]|https?:/' || true  # raw texts, messages, addresses
)
[[ -z $long ]] && { echo "lines: none is over 100 columns"; exit 0; }
cut -c -160 <<<"$long"
echo "lines: $(wc -l <<<"$long") are over 100 columns; break them" >&2
exit 1
