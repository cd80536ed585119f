#!/usr/bin/env bash
# The Debian packages in a Debian of their own (.ci/debian_root.sh): installed, started, used,
# removed. Needs root.
#   test.sh FOLDER-OF-PACKAGES FOLDER-TO-WORK-IN [SUITE]      77 = skipped
# SUITE is that of the Debian that made the packages; this machine's unless given.
set -euo pipefail
packages=$(realpath "$1")
mkdir -p "$2"
work=$(realpath "$2")
suite=${3:-$(sed -n 's/^VERSION_CODENAME=//p' /etc/os-release)}
source=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")
port=$("$source/tests/support/free_port.sh")
adminPort=$("$source/tests/support/free_port.sh")

[[ -n $(compgen -G "$packages/*.deb") ]] || {
  echo "there are no packages in $packages; make deb first" >&2
  exit 1
}

root=$work/root
server=
cleanUp() {
  [[ -z $server ]] || kill "$server" 2>/dev/null || true
  umount -q "$root/proc" "$root/dev" 2>/dev/null || true
}
trap cleanUp EXIT
fail() { echo "test-deb: $1" >&2; exit 1; }
step() { printf 'test-deb: %s\n' "$1"; }
# With the end of what the failed command wrote.
failWith() { tail -20 "$1" >&2; fail "$2"; }
inside() {
  chroot "$root" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 \
    DEBIAN_FRONTEND=noninteractive "$@"
}
get() { inside curl -fsS --max-time 20 "http://127.0.0.1:$port$1"; }
deb() { (cd "$packages" && printf '/packages/%s' "$1"_*.deb); }
install() {
  inside apt-get install -y --no-install-recommends -qq "$@" >"$work/apt.log" 2>&1 ||
    failWith "$work/apt.log" "apt-get install $*"
}

# ---- the packages' form, as Debian's own judge sees it

if command -v lintian >/dev/null; then
  step "lintian"
  lintian --allow-root --fail-on error "$packages"/*.deb || fail "lintian found errors"
else
  step "lintian is not installed; nobody judges the packages' form"
fi

# ---- a bare Debian; the first run downloads it, later ones copy it

"$source/.ci/debian_root.sh" "$work" "$suite" || exit $?
mount -t proc proc "$root/proc"
mount --bind /dev "$root/dev"
mkdir "$root/packages"
cp "$packages"/*.deb "$root/packages"
inside apt-get update -qq
install curl

# ---- the server: alone, lean, as its own user

step "qtet-server"
install "$(deb qtet-server)"
inside dpkg -l | grep -E >/dev/null 'libvtk|libgl1' && fail "qtet-server draws VTK or OpenGL in"
[[ $(stat -c %U:%a "$root/var/lib/qtet" 2>/dev/null || true) != root:* ]] ||
  fail "/var/lib/qtet belongs to root"
inside qtet-server --config /etc/qtet/server.conf --check-config | grep >/dev/null /var/lib/qtet ||
  fail "the settings do not hold"
install systemd
inside systemd-analyze verify qtet-server.service 2>"$work/unit.log" ||
  failWith "$work/unit.log" "the unit is not sound"
[[ ! -s $work/unit.log ]] || failWith "$work/unit.log" "systemd complains of the unit"
# systemd's own score of what the unit leaves open, in tenths: 0 is nothing, 100 everything.
inside systemd-analyze security --offline=true --threshold=25 --no-pager qtet-server.service \
  >"$work/security.log" 2>&1 || failWith "$work/security.log" "the unit is not hardened"
# Who may upload. (The folder's settings are root's; the token file, as the server reads it, its
# group's.)
token=$(head -c 24 /dev/urandom | base64 -w0 | tr -d '+/=')
printf 'write up-* %s\n' "$token" >"$root/etc/qtet/tokens"
inside chown root:qtet /etc/qtet/tokens
chmod 640 "$root/etc/qtet/tokens"
# exec, so that what is killed at the end is the server and not a shell before it.
(exec chroot "$root" env -i PATH=/usr/sbin:/usr/bin LC_ALL=C.UTF-8 \
  setpriv --reuid=qtet --regid=qtet --clear-groups \
  qtet-server --config /etc/qtet/server.conf --tokens /etc/qtet/tokens --port "$port" \
  --admin "127.0.0.1:$adminPort" >"$work/server.log" 2>&1) &
server=$!
for _ in {1..50}; do
  get /v1/meshes >/dev/null 2>&1 && break
  kill -0 $server || failWith "$work/server.log" "the server ended"
  sleep 0.1
done
[[ $(get /v1/meshes) == *'"meshes":[]'* ]] || fail "an empty folder is not an empty list"
get / | grep >/dev/null '<qtet-viewer\|<script' || fail "the viewer is missing"
viewer=$root/usr/share/qtet/viewer
[[ -f $viewer/index.html.gz && -f $viewer/index.html.zst ]] ||
  fail "the viewer's files are not compressed"

# ---- the tool: makes a log, which the running server takes up

step "qtet"
install "$(deb qtet)"
inside qtet sample fin -o /tmp/fin.vtu >/dev/null
inside qtet simplify /tmp/fin.vtu -o /tmp/fin.qtet >/dev/null 2>&1
inside qtet verify /tmp/fin.qtet --against /tmp/fin.vtu --quiet >/dev/null
inside qtet extract /tmp/fin.qtet --ratio 1 -o /tmp/skin.glb >/dev/null
inside install -o qtet -g qtet -m 0644 /tmp/fin.qtet /var/lib/qtet/.fin.part
inside mv /var/lib/qtet/.fin.part /var/lib/qtet/fin.qtet
for _ in {1..50}; do [[ $(get /v1/meshes) != *'"id":"fin"'* ]] || break; sleep 0.1; done
[[ $(get /v1/meshes/fin) == *'"digest"'* ]] || fail "the server does not see a new log"
meshes=http://127.0.0.1:$port/v1/meshes
inside curl -fsSL --max-time 20 "$meshes/fin/log" | cmp - "$root/tmp/fin.qtet" ||
  fail "the log arrives changed"
inside env QTET_TOKEN="$token" qtet push /tmp/fin.qtet "$meshes/up-fin" >/dev/null ||
  fail "an upload"
[[ $(get /v1/meshes/up-fin) == *'"digest"'* && -f $root/var/lib/qtet/up-fin.qtet ]] ||
  fail "the server does not have what was uploaded"
inside env QTET_TOKEN="$token" qtet push /tmp/fin.qtet "$meshes/other" >/dev/null 2>&1 &&
  fail "a token wrote what it must not"
for page in qtet qtet-simplify; do
  [[ -n $(compgen -G "$root/usr/share/man/man1/$page.1*") ]] || fail "there is no man page $page(1)"
done

# ---- the library: a program of somebody else's, and Python

step "libqtet-dev, python3-qtet"
install "$(deb libqtet0)" "$(deb libqtet-dev)" "$(deb python3-qtet)" gcc libc6-dev pkgconf \
  python3-numpy
[[ -f $root/usr/lib/$(inside gcc -print-multiarch)/libqtet.so.0 ]] ||
  fail "the library is not where Debian's other libraries are"
cp "$source/tests/consumer/levels.c" "$source/tests/consumer/simplify.c" "$root/tmp/"
inside sh -c 'cc -std=c99 /tmp/levels.c $(pkg-config --cflags --libs qtet) -o /tmp/levels &&
  /tmp/levels /tmp/fin.qtet full' | grep >/dev/null '^level 0:' || fail "levels.c"
inside sh -c 'cc -std=c99 /tmp/simplify.c $(pkg-config --cflags --libs qtet) -o /tmp/simplify &&
  /tmp/simplify /tmp/fin.qtet /tmp/again.qtet fin 0.5' >/dev/null 2>&1 || fail "simplify.c"
inside qtet verify /tmp/again.qtet --quiet >/dev/null || fail "the log that simplify.c made"
inside python3 -c 'import qtet
log = qtet.open("/tmp/fin.qtet")
print(log.refine(log.last_level), log.counts())' >/dev/null || fail "qtet.open"
inside python3 -c 'import qtet
points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
qtet.simplify(points, [[0, 1, 2, 3]], path="/tmp/one.qtet")' ||
  fail "qtet.simplify"
inside python3 -c "import qtet
qtet.open('http://127.0.0.1:$port/?mesh=fin').refine(0)" || fail "qtet.open over HTTP"

# ---- ParaView, which takes libvtk9-dev's place on Debian 12 and so cannot be where the project is
# built

step "the plugin in ParaView"
install paraview python3-paraview xvfb xauth
cp "$source/tests/codec/python/qtet_paraview_test.py" "$root/tmp/"
plugin=$(inside dpkg -L python3-qtet | grep '/paraview_plugin\.py$')
# Without -noreset a window that is opened while the server gets over the last one's end fails.
inside xvfb-run -a -s "-screen 0 1280x1024x24 -noreset" \
  pvbatch --force-offscreen-rendering /tmp/qtet_paraview_test.py "$plugin" \
  /tmp/fin.qtet /tmp "http://127.0.0.1:$port/?mesh=fin" >"$work/paraview.log" 2>&1 ||
  failWith "$work/paraview.log" "the plugin in ParaView"

# ---- and away again

step "removing"
kill $server; wait $server || true
server=
# The proper end of a service whose package goes: logs stay, everything else does not.
ours=(qtet qtet-server libqtet0 libqtet-dev python3-qtet)
mapfile -t files < <(for p in "${ours[@]}"; do inside dpkg -L "$p"; done | sort -u)
inside apt-get remove -y -qq qtet-server >"$work/apt.log" 2>&1 ||
  failWith "$work/apt.log" "apt-get remove"
[[ -f $root/etc/qtet/server.conf ]] || fail "removing took the settings, which only a purge may"
[[ ! -e $root/usr/bin/qtet-server ]] || fail "removing left the server"
rm "$root/etc/qtet/tokens"
inside apt-get purge -y -qq "${ours[@]}" >"$work/apt.log" 2>&1 ||
  failWith "$work/apt.log" "apt-get purge"
for file in "${files[@]}"; do [[ ! -f $root$file ]] || fail "$file is left behind"; done
[[ ! -e $root/etc/qtet ]] || fail "/etc/qtet is left behind"
[[ -f $root/var/lib/qtet/fin.qtet ]] || fail "a purge took somebody's log"
step "installed, started, used and removed"
