#!/usr/bin/env bash
# The wheel: built twice with the same bytes, small, its library self-contained. Installed into an
# empty environment it works with Python alone, and with numpy, meshio and VTK where they are.
#   wheel_test.sh PYTHON BIN-FOLDER SCRATCH
set -euo pipefail
python=$1 bin=$2 scratch=$3
here=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
source=$(realpath "$here/../../..")
rm -rf "$scratch" && mkdir -p "$scratch"
cd "$scratch"
unset PYTHONPATH QTET_LIBRARY

fail() { echo "wheel: $*" >&2; exit 1; }

"$python" -c 'import venv, ensurepip' 2>/dev/null || {
  echo "skipped: $python has no venv (Debian: python3-venv)"
  exit 77
}
SOURCE_DATE_EPOCH=1767225600 "$python" "$source/.packaging/python_backend.py" a >made
SOURCE_DATE_EPOCH=1767225600 "$python" "$source/.packaging/python_backend.py" b >/dev/null
wheel=$(echo a/*.whl)
cmp "$wheel" b/*.whl || fail "two builds differ"
bytes=$(stat -c %s "$wheel")
[[ $bytes -le 6200000 ]] || fail "it has $bytes bytes"

"$python" -m zipfile -e "$wheel" unpacked
library=unpacked/qtet/libqtet.so
source "$source/tests/codec/python/wheel_library.sh"
[[ $wheel == *-manylinux_2_${newest#GLIBC_2.}_* ]] ||
  fail "it is called $wheel, but needs $newest"

"$python" -m venv alone
alone/bin/pip install -q --no-index --no-deps "$wheel"
qtet=$PWD/alone/bin/qtet
(
  mkdir elsewhere && cd elsewhere
  export PATH=/usr/bin:/bin
  [[ $("$qtet" --version) == "$("$bin/qtet" --version)" ]] || fail "its version is another one"
  "$qtet" sample box -o box.vtu -q
  "$qtet" simplify box.vtu -o box.qtet -q
  "$bin/qtet" simplify box.vtu -o other.qtet -q
  cmp box.qtet other.qtet || fail "its log is another one"
  "$qtet" info box.qtet >words
  grep -q '3,072 tetrahedra' words || fail "info says something else"
  "$qtet" verify box.qtet --against box.vtu >/dev/null
  "$qtet" extract box.qtet --level 0 -o coarse.vtk -q
  "$qtet" convert box.vtu -o box.msh -q
  "$qtet" publish site box.qtet -q
  code=0
  "$qtet" simplify nothing.vtu -o no.qtet 2>words || code=$?
  [[ $code == 1 ]] && grep -q '^qtet: .*nothing.vtu' words || fail "a missing file ends with $code"
  code=0
  "$qtet" simplfy 2>words || code=$?
  [[ $code == 2 ]] || fail "an unknown command ends with $code"
  # the address comes first, and Ctrl-C takes the temporary files away
  mkdir temporary
  TMPDIR=$PWD/temporary "$qtet" view box.vtu --no-open >address 2>words &
  view=$!
  for _ in $(seq 200); do [[ -s address ]] && break || sleep 0.1; done
  curl -fsS --max-time 20 "$(cat address)index.json" >words
  grep -q '"box"' words || fail "view shows no box"
  kill -TERM $view
  wait $view || fail "view ends with $?"
  [[ -z $(ls -A temporary) ]] || fail "view leaves $(ls temporary)"
)
alone/bin/python - <<'END'
import qtet
with qtet.open("elsewhere/box.qtet") as log:
    log.refine(0)
    assert log.counts()[1] > 0
END

"$python" -m venv --system-site-packages with
with/bin/pip install -q --no-index --no-deps "$wheel"
with/bin/python "$here/wheel_test.py" elsewhere
echo "wheel: $bytes bytes, needs $newest"
