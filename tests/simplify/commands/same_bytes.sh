#!/usr/bin/env bash
# Same input, same options, same bytes, whatever the compiler, its optimisation and the number of
# threads. The tool that users run (g++) is compared with the one of the unit tests (clang,
# sanitizers), and both with the golden files' digests.
#   same_bytes.sh QTET CHECKED-QTET GOLDEN-FOLDER FOLDER-TO-WRITE-TO     77: no CHECKED-QTET
set -euo pipefail
qtet=$1 checked=$2 golden=$(realpath "$3")
[[ -x $checked ]] || { echo "skipped: $checked is not built (make build-checked)"; exit 77; }
mkdir -p "$4"
cd "$4"
fail() { echo "same_bytes: $1" >&2; exit 1; }

for sample in box fin; do
  "$qtet" sample $sample -o $sample.vtu >/dev/null
  "$checked" sample $sample -o checked.vtu >/dev/null
  cmp $sample.vtu checked.vtu || fail "the sample $sample"
done
# A graded mesh of 6,000 cells: sanitizers take a minute for the whole fin.
"$qtet" simplify fin.vtu -o fin.qtet -q --measure none --fields Density 2>notes.txt
"$qtet" extract fin.qtet --ratio 0.03 -o part.vtu >/dev/null
while read -r words; do
  # shellcheck disable=SC2086
  "$qtet" simplify part.vtu -o log.qtet -q --threads 2 $words 2>>notes.txt
  # shellcheck disable=SC2086
  "$checked" simplify part.vtu -o checked.qtet -q $words 2>>notes.txt
  cmp log.qtet checked.qtet || fail "the log with options '$words'"
done <<'END'

--lossless --keep-order --geometry-codec adaptive --placement optimal --envelope-tolerance 0.01
--algorithm paper --measure none
--placement vertex --boundary-weight 30 --measure none
END

while read -r digest name; do
  "$qtet" verify "$golden/valid/$name" --json | grep -q "$digest" || fail "the golden $name"
done <"$golden/digests.txt"
