#!/usr/bin/env bash
# Compares the logs that a program makes with tests/same_bytes.txt, line by line.
#   doors.sh DOOR COMMAND...       0: the same. 1: differs, with those lines (- table, + made).
#   doors.sh all BUILD CHECKED     Compares every door that is built; "skipped" names the others.
#   doors.sh --write COMMAND...    Writes the table again.
set -euo pipefail
here=$(dirname "${BASH_SOURCE[0]}")
table=$here/../same_bytes.txt
head='# SHA-256 of logs, the same from every compiler, processor and number of threads.
# `make same-bytes` compares; `make same-bytes WRITE=1` writes it again, after a change that means
# to make other logs. Lines are commands of qtet, for the meshes of `same_bytes --meshes FOLDER`.'

door() {
  local name=$1 start=$SECONDS made
  shift
  made=$("$@") || { echo "same_bytes: $name: $1 failed" >&2; return 1; }
  diff -U0 --label "tests/same_bytes.txt" --label "$name" <(grep -v '^#' "$table") \
    <(echo "$made") || { echo "same_bytes: $name makes other logs" >&2; return 1; }
  echo "same_bytes: $name: $(wc -l <<<"$made") logs as in the table, $((SECONDS - start)) s"
}

case $1 in
  --write)
    made=$("${@:2}")
    printf '%s\n%s\n' "$head" "$made" >"$table"
    echo "same_bytes: wrote $(wc -l <<<"$made") lines" ;;
  all)
    native=$2/bin/same_bytes checked=$3/bin/same_bytes arm=$2/aarch64/same_bytes failed=
    qemu=$(command -v qemu-aarch64 || command -v qemu-aarch64-static || true)
    door "g++, one thread" "$native" || failed=1
    door "g++, two threads" "$native" --threads 2 || failed=1
    if [[ -x $checked ]]; then
      door "clang with sanitizers" "$checked" || failed=1
    else
      echo "skipped: clang with sanitizers (make build-checked)"
    fi
    if [[ ! -x $arm ]]; then
      echo "skipped: aarch64 (install g++-aarch64-linux-gnu and qemu-user)"
    elif [[ -z $qemu ]]; then
      echo "skipped: aarch64 (install qemu-user)"
    else
      door "aarch64" "$qemu" "$arm" || failed=1
    fi
    wasm=$(realpath "$2")/web-client/qtet-codec.wasm
    if [[ -s $2/web-client/qtet-simplify.wasm ]]; then
      (cd "$here/../../web-client" &&
        QTET_WASM=$wasm npm test --silent -- tests/same_bytes.test.ts) || failed=1
    else
      echo "skipped: WebAssembly (the build did without its simplifier)"
    fi
    [[ -z $failed ]] || exit 1 ;;
  *) door "$@" ;;
esac
