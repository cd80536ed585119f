#!/usr/bin/env bash
# The tool that users run (g++, optimised) decodes the golden files to the digests that the unit
# tests (clang, sanitizers) and the second decoder find.
#   verify.sh QTET GOLDEN-FOLDER
set -euo pipefail
while read -r digest name; do
  "$1" verify "$2/valid/$name" --json | grep -q "$digest" ||
    { echo "golden: $name has another digest than $2/digests.txt says" >&2; exit 1; }
done <"$2/digests.txt"
