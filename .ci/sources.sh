#!/usr/bin/env bash
# Unpacks the sources of Debian packages below build/sources, with Debian's patches: libraries that
# WebAssembly is made of and that Debian builds for processors alone. METIS is linked statically
# elsewhere, too: Debian's library is shared alone.
#   .ci/sources.sh        does nothing for what is there already
# Where they cannot be had, a build does without. Continuous integration (CI=true) fails instead:
# the tests of the simplifier as WebAssembly would skip.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
folder=build/sources
# All are those of this Debian, as the packages that the programs are linked with.
wanted=(boost draco expat libdeflate libwebp lz4 metis xz-utils zlib)
missing=()
for name in "${wanted[@]}"; do
  compgen -G "$folder/$name-[0-9]*/" >/dev/null || missing+=("$name")
done
[[ ${#missing[@]} == 0 ]] && exit 0
without() {
  if [[ ${CI:-} == true ]]; then
    echo "setup: $1. Without the sources of ${missing[*]} the tests of the simplifier as" \
      "WebAssembly would skip. Install dpkg-dev, let apt reach a mirror of Debian, and run" \
      ".ci/sources.sh again. Or build without CI=true." >&2
    exit 1
  fi
  echo "setup: $1; the simplifier as WebAssembly is left out: the page takes dropped logs alone," \
    "and the npm package has no command; where the sources of METIS are missing, qtet-portable" \
    "and the wheel refuse --parts" >&2
  exit 0
}
command -v dpkg-source >/dev/null || without "there is no dpkg-source"
printf 'setup: fetching the sources of %s\n' "${missing[*]}"
source .ci/own_apt.sh
trap 'rm -rf $folder/apt' EXIT
# The name of Boost's package has its version, 1.74 in Debian 12.
boost=$(dpkg-query -W -f '${Depends}' libboost-program-options-dev |
  sed -n 's/.*libboost-program-options\([0-9.]*\)-dev.*/\1/p')
fetch() {
  own_apt_begin $folder/apt deb-src && own_apt update && cd $folder/apt || return
  for name in "${missing[@]}"; do
    if [[ $name != boost ]]; then
      own_apt source "$name" >/dev/null || return
      continue
    fi
    # All of Boost would be 600 MB: one of its libraries has to be compiled.
    own_apt source --download-only "boost$boost" >/dev/null &&
      mkdir "boost-$boost" && tar -xf "boost$boost"_*.orig.tar.* -C "boost-$boost" \
      --strip-components=1 --wildcards '*/libs/program_options/src/*' || return
  done
}
(fetch) || without "Debian's sources cannot be fetched (the reason stands above)"
for name in "${missing[@]}"; do
  rm -rf $folder/apt/"$name"-[0-9]*/testdata # 140 MB of Draco's
  mv $folder/apt/"$name"-[0-9]*/ $folder/
done
