#!/usr/bin/env bash
# A bare Debian in a folder, to install and try things in. Needs root, and mmdebstrap or
# debootstrap. The first run downloads it to FOLDER/SUITE; each run copies it to FOLDER/root.
#   debian_root.sh FOLDER [SUITE]     SUITE: bookworm (Debian 12, the default) or trixie (13);
#                                     77 = skipped, and says why
# QTET_DEBIAN_MIRROR names another mirror than the program's default.
set -euo pipefail
mkdir -p "$1"
work=$(realpath "$1")
suite=${2:-bookworm}
mirror=${QTET_DEBIAN_MIRROR:-}
skip() { echo "skipped: $1"; exit 77; }
[[ $(id -u) == 0 ]] || skip "a chroot needs root"

if [[ ! -d $work/$suite ]]; then
  echo "making a Debian $suite in $work/$suite"
  rm -rf "$work/$suite.part"
  if command -v mmdebstrap >/dev/null; then
    make=(mmdebstrap --quiet --variant=minbase "$suite" "$work/$suite.part")
  elif command -v debootstrap >/dev/null; then
    make=(debootstrap --variant=minbase "$suite" "$work/$suite.part")
  else
    skip "neither mmdebstrap nor debootstrap is installed"
  fi
  "${make[@]}" ${mirror:+"$mirror"} >"$work/debian.log" 2>&1 || {
    tail -5 "$work/debian.log" >&2
    mirror=${mirror:-the default mirror; QTET_DEBIAN_MIRROR=URL names another}
    skip "Debian could not be fetched from $mirror"
  }
  mv "$work/$suite.part" "$work/$suite"
fi
for mounted in $(awk -v root="$work/root/" 'index($2, root) == 1 {print $2}' /proc/mounts |
  sort -r); do umount "$mounted"; done
rm -rf --one-file-system "$work/root"
cp -a "$work/$suite" "$work/root"
# Names and local certificates, which this machine needs to reach the network.
cp --dereference /etc/resolv.conf /etc/hosts "$work/root/etc/"
mkdir -p "$work/root/usr/local/share"
[[ ! -d /usr/local/share/ca-certificates ]] ||
  cp -a /usr/local/share/ca-certificates "$work/root/usr/local/share/"
