#!/usr/bin/env bash
# Runs a test of test scripts where something of it has changed, and skips (77) where nothing has.
#   when_changed.sh PATH... -- COMMAND [WORD...]     QTET_ALL=1 in the environment: always
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
paths=()
while [[ $1 != -- ]]; do paths+=("$1") && shift; done
shift
if [[ -z ${QTET_ALL:-} ]] && changed=$("$root/.ci/changed.sh" "" "${paths[@]}") &&
  [[ -z $changed ]]; then
  echo "skipped: nothing changed in ${paths[*]}; QTET_ALL=1 runs it all the same"
  exit 77
fi
exec "$@"
