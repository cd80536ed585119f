#!/usr/bin/env bash
# Proves that check.sh can fail: each forged repository breaks one arrow, and the message must name
# the file and line.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
failures=0

# A small repository in which every arrow holds.
soundTree() {
  rm -rf "$scratch/repo"
  mkdir -p "$scratch"/repo/{proto,codec/{coding,mesh},simplify,server,web-client/{core,viewer}}
  cd "$scratch/repo"
  printf '#pragma once\n#include <vector>\n' >proto/bytes.h
  printf '#pragma once\n#include "proto/bytes.h"\n' >codec/mesh.h
  printf '#include "codec/mesh.h"\n#include <draco/mesh/mesh.h>\n' >codec/mesh.cpp
  printf '#include <vtkPoints.h>\n#include "codec/mesh.h"\n' >simplify/main.cpp
  printf '#include <boost/asio.hpp>\n\n#include "codec/mesh.h"\n#include "proto/bytes.h"\n' \
    >server/main.cpp
  printf '#pragma once\n' >codec/coding/bits.h
  printf '#pragma once\n#include "codec/coding/bits.h"\n' >codec/mesh/star.h
  printf 'export const bits = 1\n' >web-client/core/bits.ts
  printf "import { bits } from './bits'\n" >web-client/core/mesh.ts
  printf "import {\n  bits,\n} from '../core/bits'\nimport './style.css'\n" \
    >web-client/viewer/page.ts
  printf 'target_link_libraries(qtet_server PUBLIC qtet::codec)  # never qtet::simplify\n' \
    >server/CMakeLists.txt
}

accepts() { # what
  if ! bash "$here/check.sh" "$scratch/repo" >"$scratch/out" 2>&1; then
    echo "FAILED: $1 is refused:"
    cat "$scratch/out"
    failures=1
  fi
}

refuses() { # what, text expected in the message
  if bash "$here/check.sh" "$scratch/repo" >"$scratch/out" 2>&1; then
    echo "FAILED: $1 is not noticed"
    failures=1
  elif ! grep -qF -- "$2" "$scratch/out"; then
    echo "FAILED: $1 is noticed, but the message lacks '$2':"
    cat "$scratch/out"
    failures=1
  fi
}

soundTree; accepts "a sound tree"
soundTree; echo '#include "simplify/fusion.h"' >>server/main.cpp; : >simplify/fusion.h
refuses "server including simplify" \
  'server/main.cpp:5: server/ must not include "simplify/fusion.h"'
soundTree; echo '  #  include "codec/mesh.h"' >>proto/bytes.h
refuses "proto including codec" 'proto/bytes.h:3: proto/ must not include "codec/mesh.h"'
soundTree; echo '#include "server/x.h"' >>codec/mesh.cpp; : >server/x.h
refuses "codec including server" 'codec/mesh.cpp:3: codec/ must not include "server/x.h"'
soundTree; echo '#include <vtkCell.h>' >>codec/mesh.h
refuses "codec including VTK" 'codec/mesh.h:3: codec/ must not include <vtkCell.h>'
soundTree; echo '#include <boost/asio/ip/tcp.hpp>' >>codec/mesh.h
refuses "codec including Boost.Asio" \
  'codec/mesh.h:3: codec/ must not include <boost/asio/ip/tcp.hpp>'
soundTree; echo '#include <vtkCell.h>' >>server/main.cpp
refuses "server including VTK" 'server/main.cpp:5: server/ must not include <vtkCell.h>'
soundTree; echo '#include "mesh.h"' >>codec/mesh.cpp
refuses "an include that is not written from the root" 'codec/mesh.cpp:3: "mesh.h" is no file'
soundTree; echo '#include "codec/gone.h"' >>codec/mesh.cpp
refuses "an include of a file that does not exist" 'codec/mesh.cpp:3: "codec/gone.h" is no file'
soundTree; echo '#include "codec/mesh.h"' >web-client/stub.cpp
refuses "web-client including codec" \
  'web-client/stub.cpp:1: web-client/ must not include "codec/mesh.h"'
soundTree; echo 'target_link_libraries(x PRIVATE qtet::simplify)' >>server/CMakeLists.txt
refuses "server linking simplify" 'server/CMakeLists.txt:2: server/ must not link qtet::simplify'
soundTree; printf '#include "codec/b.h"\n' >codec/a.h; printf '#include "codec/c.h"\n' >codec/b.h
printf '#include "codec/a.h"\n' >codec/c.h
refuses "a circle of three headers" 'codec/b.h'
soundTree; printf '#pragma once\n#include "codec/mesh/star.h"\n' >codec/coding/models.h
refuses "a circle of two folders" 'these folders stand in a circle'
refuses "a circle of two folders" 'codec/coding'
soundTree; printf "import { a } from './mesh'\nexport const bits = a\n" >web-client/core/bits.ts
refuses "a circle of two modules" 'web-client/core/mesh.ts'
soundTree; printf "import type { A } from './mesh'\n" >web-client/core/bits.ts
refuses "a circle of types" 'these modules stand in a circle'
soundTree; printf "export * from '../viewer/page'\n" >web-client/core/other.ts
refuses "core importing the viewer" 'web-client/core/ must not import from web-client/viewer/'
soundTree; mkdir web-client/core/{protocol,decode}; : >web-client/core/decode/codec.ts
printf "import '../decode/codec'\n" >web-client/core/protocol/limit.ts
refuses "the protocol importing a decoder" \
  'web-client/core/protocol/ must not import from web-client/core/decode/'
soundTree; mkdir web-client/core/attic; printf "import '../bits'\n" >web-client/core/attic/old.ts
refuses "a folder without a place" 'web-client/core/attic/ has no place yet'
soundTree; mkdir server/utils
refuses "a folder called utils" 'server/utils: no folder may be called'
soundTree; mkdir common
refuses "a folder called common" 'common: no folder may be called'
soundTree; mkdir -p web-client/node_modules/three/common build/utils
accepts "a folder of that name among what was fetched or built"

if [[ $failures == 0 ]]; then echo "arrows: the check refuses every forged breach"; fi
exit $failures
