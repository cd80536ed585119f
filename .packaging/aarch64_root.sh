#!/usr/bin/env bash
# Unpacks Debian's arm64 packages to build/aarch64/root: the libraries that the build is linked
# with, and Python with numpy, which run there under qemu. Nothing is installed on this machine.
#   .packaging/aarch64_root.sh        does nothing where they are already, as packages.txt names
#                                     them; remove the folder to take newer ones
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
folder=build/aarch64 root=build/aarch64/root
mapfile -t wanted < <(sed '/^# ==== tests/,$d; s/#.*//' .ci/packages.txt |
  grep -o '[^[:space:]]*-dev$')
wanted+=(python3-numpy)
[[ $(cat $root/wanted 2>/dev/null) != "${wanted[*]}" ]] || exit 0
source .ci/own_apt.sh
trap 'rm -rf $folder/apt $root.part' EXIT
echo "aarch64: fetching ${#wanted[@]} packages and what they need"
own_apt_begin $folder/apt deb arm64
own_apt update
own_apt install --yes --no-install-recommends --download-only "${wanted[@]}"
rm -rf $root $root.part
mkdir -p $root.part/usr/{bin,lib,sbin}
for name in bin lib sbin; do ln -s usr/$name $root.part/$name; done
for package in $folder/apt/cache/archives/*.deb; do
  dpkg-deb --fsys-tarfile "$package" |
    tar -x --keep-directory-symlink --no-same-owner -C $root.part --exclude='./usr/share/man/*' \
      --exclude='./usr/share/locale/*'
done
# numpy's, where a package's script would point.
libraries=$root.part/usr/lib/aarch64-linux-gnu
ln -s blas/libblas.so.3 lapack/liblapack.so.3 $libraries
# Draco's files for CMake name its libraries by their place in a whole system.
sed -i 's|"/usr/lib/|"${CMAKE_SYSROOT}/usr/lib/|' $libraries/cmake/draco/draco-targets-*.cmake
echo "${wanted[*]}" >$root.part/wanted
mv $root.part $root
