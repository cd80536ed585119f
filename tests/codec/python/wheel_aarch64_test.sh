#!/usr/bin/env bash
# Runs the wheel that `make wheel ARCH=aarch64` made, by Debian's Python for aarch64 under qemu. It
# needs the C library alone, and its logs have the bytes of this processor's.
#   wheel_aarch64_test.sh PYTHON BUILD SCRATCH
set -euo pipefail
python=$1 build=$2 scratch=$3
source=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../../..")
root=$source/build/aarch64/root
rm -rf "$scratch" && mkdir -p "$scratch"
cd "$scratch"
unset PYTHONPATH QTET_LIBRARY

fail() { echo "wheel_aarch64: $*" >&2; exit 1; }
skip() { echo "skipped: $*"; exit 77; }

qemu=$(command -v qemu-aarch64 || command -v qemu-aarch64-static) || skip "install qemu-user"
wheel=$(find "$build/wheels" -name '*_aarch64.whl' -printf '%T@ %p\n' 2>/dev/null | sort -n |
  sed -n '$s/^[^ ]* //p') || true  # where nothing was made
[[ -n $wheel ]] || skip "there is no wheel; run make wheel ARCH=aarch64"
[[ $wheel -nt $build/bin/qtet ]] || skip "qtet is newer; run make wheel ARCH=aarch64 again"
bytes=$(stat -c %s "$wheel")
[[ $bytes -le 6200000 ]] || fail "it has $bytes bytes"

"$python" -m zipfile -e "$wheel" unpacked
library=unpacked/qtet/libqtet.so
source "$source/tests/codec/python/wheel_library.sh"

! grep -qF "$source" "$library" || fail "its library holds this folder's name"

emulated() {
  PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$PWD/unpacked "$qemu" -L "$root" "$root/usr/bin/python3" "$@"
}
native() {
  PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$source/codec/python \
    QTET_LIBRARY=$build/lib/libqtet.so "$python" "$@"
}
[[ $(emulated -c 'import platform; print(platform.machine())') == aarch64 ]] || fail "this is not aarch64"
[[ $(emulated -m qtet --version) == "$("$build/bin/qtet" --version)" ]] || fail "another version"
cat >again.py <<'END'
import sys
import qtet

class Mesh:  # as meshio's
    pass

with qtet.open(sys.argv[1]) as log:
    log.refine(log.info.levels - 1)
    arrays = log.arrays()
block = Mesh()
block.type, block.data = "tetra", arrays.cells
Mesh.points, Mesh.cells = arrays.points, [block]
Mesh.point_data, Mesh.cell_data = arrays.point_data, {}
qtet.simplify(Mesh, path=sys.argv[2])
END
for mesh in fin box; do
  "$build/bin/qtet" sample $mesh -o $mesh.vtu -q
  "$build/bin/qtet" simplify $mesh.vtu -o $mesh.qtet -q
  start=$SECONDS
  emulated -m qtet simplify $mesh.vtu -o emulated.qtet -q
  cmp $mesh.qtet emulated.qtet || fail "its log of $mesh is another one"
  echo "wheel_aarch64: $mesh: the same $(stat -c %s $mesh.qtet) bytes, $((SECONDS - start)) s"
done
native again.py box.qtet a.qtet
emulated again.py box.qtet b.qtet
cmp a.qtet b.qtet || fail "its log of arrays is another one"
echo "wheel_aarch64: $bytes bytes, needs $newest"
