#!/usr/bin/env bash
# Continuous integration in a separate bare Debian 12, from a clean clone of the last commit. Only
# the packages of .ci/packages.txt are installed there. Needs root, and mmdebstrap or debootstrap.
#   fresh.sh [FOLDER]      the log is FOLDER/fresh.log; FOLDER is build/fresh unless given
set -euo pipefail
# The mounts are this process's own and go with it.
[[ -n ${QTET_OWN_MOUNTS:-} ]] ||
  QTET_OWN_MOUNTS=1 exec unshare --mount --propagation private "$0" "$@"
source=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")
work=${1:-$source/build/fresh}
mkdir -p "$work"
work=$(realpath "$work")
"$source/.ci/debian_root.sh" "$work"
root=$work/root
mount -t proc proc "$root/proc"
mount --rbind /sys "$root/sys"
mount --rbind /dev "$root/dev"
mkdir -p "$root/dev/shm"
mount -t tmpfs -o mode=1777 tmpfs "$root/dev/shm"
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
