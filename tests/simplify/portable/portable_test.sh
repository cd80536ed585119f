#!/usr/bin/env bash
# The program that is linked statically needs the C library alone, glibc 2.28 or later, and makes
# the log that qtet makes. It says so where it lacks VTK or HTTP.
#   portable_test.sh QTET QTET_PORTABLE MESHES SCRATCH
set -euo pipefail
qtet=$1 portable=$2 meshes=$3 scratch=$4
rm -rf "$scratch" && mkdir -p "$scratch"

fail() { echo "portable: $*" >&2; exit 1; }

others=$(ldd "$portable" | grep -vE 'linux-vdso|ld-linux|lib(c|m|dl|pthread)\.so\.' || true)
[[ -z $others ]] || fail "it needs $others"
newest=$(objdump -T "$portable" | grep -o 'GLIBC_[0-9.]*' | sort -uV | tail -1)
# Releases are built on Debian 12, whose own is 2.36.
most=GLIBC_$(getconf GNU_LIBC_VERSION | cut -d' ' -f2)
[[ $most != GLIBC_2.36 ]] || most=GLIBC_2.28
[[ $(printf '%s\n' "$newest" "$most" | sort -V | tail -1) == "$most" ]] || fail "it needs $newest"

for mesh in run.pvd p.pvtu gmsh-mixed1.msh ens.0.case; do
  for program in qtet portable; do
    "${!program}" convert "$meshes/$mesh" -o "$scratch/$program.vtu" --quiet 2>/dev/null
  done
  cmp "$scratch/qtet.vtu" "$scratch/portable.vtu" || fail "$mesh is read otherwise"
done

# a case of OpenFOAM
foam() {  # FILE CLASS BODY
  mkdir -p "$(dirname "$1")"
  printf 'FoamFile\n{\n format ascii;\n class %s;\n}\n%s\n' "$2" "$3" >"$1"
}
mesh=$scratch/case/constant/polyMesh
foam "$mesh/points" vectorField '4((0 0 0) (1 0 0) (0 1 0) (0 0 1))'
foam "$mesh/faces" faceList '4(3(0 2 1) 3(0 1 3) 3(0 3 2) 3(1 2 3))'
foam "$mesh/owner" labelList '4{0}'
foam "$mesh/neighbour" labelList '0()'
foam "$mesh/boundary" polyBoundaryMesh '1(walls { type wall; nFaces 4; startFace 0; })'
foam "$scratch/case/0.5/T" volScalarField 'internalField nonuniform List<scalar> 1(7);'
for program in qtet portable; do
  "${!program}" convert "$scratch/case" -o "$scratch/$program.vtu" --quiet 2>/dev/null
done
cmp "$scratch/qtet.vtu" "$scratch/portable.vtu" || fail "OpenFOAM is read otherwise"
"$portable" check "$scratch/case" | grep -q '1 tetrahedr' || fail "it does not read OpenFOAM"

"$qtet" sample box -o "$scratch/box.vtu" --quiet
for program in qtet portable; do
  "${!program}" simplify "$scratch/box.vtu" -o "$scratch/$program.qtet" --quiet
done
cmp "$scratch/qtet.qtet" "$scratch/portable.qtet" || fail "its log is another one"

# through VTK's module for Python
for program in qtet portable; do
  "${!program}" convert "$meshes/structured.cgns" -o "$scratch/$program.vtu" --quiet 2>/dev/null
done
cmp "$scratch/qtet.vtu" "$scratch/portable.vtu" || fail "CGNS is read otherwise"
! QTET_TOKEN=x "$portable" push "$scratch/qtet.qtet" http://localhost/ 2>"$scratch/words" ||
  fail "it pushes"
grep -q 'curl -T' "$scratch/words" || fail "it does not say how to send a log"
echo "portable: $(stat -c %s "$portable") bytes, needs $newest"
