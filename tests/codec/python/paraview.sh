#!/usr/bin/env bash
# The ParaView plugin in ParaView itself, where that is installed.
#   paraview.sh LIBRARY QTET-PROGRAM MODULES FOLDER-TO-WRITE-TO      77 = skipped
set -euo pipefail
command -v pvbatch >/dev/null || {
  echo "skipped: pvbatch is not installed (Debian: paraview, which takes the place of libvtk9-dev)"
  exit 77
}
# Debian has the module in a package of its own, and pvbatch without it may end with 0.
printf 'import paraview.simple\nprint("paraview" + " module")\n' >"$4/paraview_module.py"
pvbatch "$4/paraview_module.py" 2>/dev/null | grep -q '^paraview module$' || {
  echo "skipped: pvbatch has no Python module paraview (Debian: python3-paraview)"
  exit 77
}
"$2" sample fin -o "$4/paraview.vtu" >/dev/null
"$2" simplify "$4/paraview.vtu" -o "$4/paraview.qtet" >/dev/null
display=()
[[ -n ${DISPLAY:-} ]] || ! command -v xvfb-run >/dev/null || display=(xvfb-run -a)
here=$(dirname "${BASH_SOURCE[0]}")
QTET_LIBRARY=$1 exec "${display[@]}" pvbatch --force-offscreen-rendering \
  "$here/qtet_paraview_test.py" "$3/qtet/paraview_plugin.py" "$4/paraview.qtet" "$4"
