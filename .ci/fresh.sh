#!/usr/bin/env bash
# A command of the repository, continuous integration unless given, in a separate bare Debian, from
# a clean clone of the last commit. Only the packages of .ci/packages.txt are installed there. Needs
# root, and mmdebstrap or debootstrap.
#   fresh.sh [SUITE [COMMAND...]]     SUITE: bookworm (Debian 12, the default) or trixie (13);
#                                     the log is build/fresh/SUITE.log
set -euo pipefail
# The mounts are this process's own and go with it.
[[ -n ${QTET_OWN_MOUNTS:-} ]] ||
  QTET_OWN_MOUNTS=1 exec unshare --mount --propagation private "$0" "$@"
source=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")
suite=${1:-bookworm}
command=("${@:2}")
[[ ${#command[@]} != 0 ]] || command=(.ci/run)
work=$source/build/fresh
"$source/.ci/debian_root.sh" "$work" "$suite"
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
echo "fresh: $suite, ${command[*]}: $(git -C "$source" log -1 --format='%h %s')" |
  tee "$work/$suite.log"
inside sh -c 'cd /qtet && exec "$@"' sh "${command[@]}" 2>&1 | while IFS= read -r line; do
  printf '%(%T)T %s\n' -1 "$line"
done | tee -a "$work/$suite.log"
