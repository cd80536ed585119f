#!/usr/bin/env bash
# Unpacks the sources of Debian packages below build/sources, with Debian's patches: libraries that
# the browser needs as WebAssembly and that Debian builds for processors alone. METIS is
# linked statically elsewhere, too: Debian's library is shared alone.
#   .ci/sources.sh        does nothing for what is there already
# Where they cannot be had, a build does without. Continuous integration (CI=true) fails instead:
# the tests of the browser's simplifier would skip.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
folder=build/sources
# All are those of this Debian, as the packages that the programs are linked with.
wanted=(draco expat libdeflate lz4 metis xz-utils)
missing=()
for name in "${wanted[@]}"; do
  compgen -G "$folder/$name-[0-9]*/" >/dev/null || missing+=("$name")
done
[[ ${#missing[@]} == 0 ]] && exit 0
without() {
  if [[ ${CI:-} == true ]]; then
    echo "setup: $1. Without the sources of ${missing[*]} the tests of the browser's simplifier" \
      "would skip. Install dpkg-dev, let apt reach a mirror of Debian, and run .ci/sources.sh" \
      "again. Or build without CI=true." >&2
    exit 1
  fi
  echo "setup: $1; the browser's simplifier is left out, and the page takes dropped logs alone;" \
    "where the sources of METIS are missing, qtet-portable and the wheel refuse --parts" >&2
  exit 0
}
command -v dpkg-source >/dev/null || without "there is no dpkg-source"
printf 'setup: fetching the sources of %s\n' "${missing[*]}"
source .ci/own_apt.sh
trap 'rm -rf $folder/apt' EXIT
fetch() {
  own_apt_begin $folder/apt deb-src && own_apt update && cd $folder/apt &&
    own_apt source "${missing[@]}" >/dev/null
}
(fetch) || without "Debian's sources cannot be fetched (the reason stands above)"
for name in "${missing[@]}"; do
  rm -rf $folder/apt/"$name"-[0-9]*/testdata # 140 MB of Draco's
  mv $folder/apt/"$name"-[0-9]*/ $folder/
done
