#!/usr/bin/env bash
# Continuous integration in a separate bare Debian 12, from a clean clone of the last commit. Only
# the packages of .ci/packages.txt are installed there. Needs root, and mmdebstrap or debootstrap.
#   fresh.sh [FOLDER]      the log is FOLDER/fresh.log; FOLDER is build/fresh unless given
set -euo pipefail
source=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")
work=${1:-$source/build/fresh}
mkdir -p "$work"
work=$(realpath "$work")
"$source/.ci/debian_root.sh" "$work"
root=$work/root
mounted=()
cleanUp() {
  for ((i = ${#mounted[@]} - 1; i >= 0; --i)); do umount -l "${mounted[$i]}" || true; done
}
trap cleanUp EXIT
mountIn() {
  local place=$root/${!#}
  mkdir -p "$place"
  mount "${@:1:$#-1}" "$place"
  mounted+=("$place")
}
mountIn -t proc proc proc
mountIn --rbind /sys sys
mountIn --bind /dev dev
mountIn -t tmpfs -o mode=1777 tmpfs dev/shm
git clone -q --no-local --no-hardlinks "$source" "$root/qtet"
inside() {
  chroot "$root" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 \
    DEBIAN_FRONTEND=noninteractive "$@"
}
# A user needs git to clone and make to build.
inside sh -c 'apt-get update -qq && apt-get install -y -qq --no-install-recommends git make' \
  >"$work/apt.log" 2>&1 || { tail -20 "$work/apt.log" >&2; exit 1; }
echo "fresh: $(git -C "$source" log -1 --format='%h %s')" | tee "$work/fresh.log"
inside /qtet/.ci/run 2>&1 | while IFS= read -r line; do
  printf '%(%T)T %s\n' -1 "$line"
done | tee -a "$work/fresh.log"
