#!/usr/bin/env bash
# Same input, same options, same bytes, whatever the compiler, its optimisation and the number of
# threads: the tool that users run (g++) against the one of the unit tests (clang, sanitizers), and
# both against the golden files' digests.
#   same_bytes.sh QTET CHECKED-QTET GOLDEN-FOLDER FOLDER-TO-WRITE-TO     77: no CHECKED-QTET
set -euo pipefail
qtet=$1 checked=$2 golden=$(realpath "$3")
[[ -x $checked ]] || { echo "skipped: $checked is not built (make build-checked)"; exit 77; }
mkdir -p "$4"
cd "$4"
fail() { echo "same_bytes: $1" >&2; exit 1; }

"$qtet" sample fin --cells 6000 -o fin.vtu >/dev/null
"$checked" sample fin --cells 6000 -o fin-checked.vtu >/dev/null
cmp fin.vtu fin-checked.vtu || fail "a sample"
while read -r words; do
  # shellcheck disable=SC2086
  "$qtet" simplify fin.vtu -o log.qtet -q --threads 2 $words
  # shellcheck disable=SC2086
  "$checked" simplify fin.vtu -o checked.qtet -q $words
  cmp log.qtet checked.qtet || fail "the log with options '$words'"
done <<'END'

--lossless --keep-order --geometry-codec adaptive --placement optimal --envelope-tolerance 0.01
--layout regions --cells-per-packet 400 --fields Density
--algorithm paper --measure none
--measure all --placement vertex --boundary-weight 30
END

while read -r digest name; do
  "$qtet" verify "$golden/valid/$name" --json | grep -q "$digest" || fail "the golden $name"
done <"$golden/digests.txt"
