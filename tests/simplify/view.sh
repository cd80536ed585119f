#!/usr/bin/env bash
# `qtet view` of a mesh: a URL is printed, the log is served there, and a signal ends it all and leaves nothing behind.
#   view.sh QTET-PROGRAM FOLDER-TO-WRITE-TO
set -euo pipefail
mkdir -p "$2/temporary"
cd "$2"
export TMPDIR=$PWD/temporary
fail() { echo "view: $1" >&2; cat err.txt >&2; exit 1; }
"$1" sample box -o "a box.vtu" >/dev/null
rm -f url.txt  # of an earlier run
env -u DISPLAY -u WAYLAND_DISPLAY "$1" view "a box.vtu" >url.txt 2>err.txt &
view=$!
trap 'kill $view 2>/dev/null || true' EXIT
for _ in {1..300}; do [[ ! -s url.txt ]] || break; kill -0 $view 2>/dev/null || fail "it ended"; sleep 0.1; done
url=$(<url.txt)
[[ $url =~ ^http://127\.0\.0\.1:([0-9]+)/\?mesh=a_box$ ]] || fail "the URL is '$url'"
exec 3<>"/dev/tcp/127.0.0.1/${BASH_REMATCH[1]}"
printf 'GET /v1/meshes/a_box HTTP/1.0\r\nHost: localhost\r\n\r\n' >&3
grep -q '"tetrahedra":3072' <&3 || fail "the log is not served"
[[ -n $(ls temporary) ]] || fail "the log lies elsewhere"
kill -TERM $view
wait $view || fail "it ended with $?"
[[ -z $(ls temporary) ]] || fail "left behind: $(ls temporary)"
(exec 3<>"/dev/tcp/127.0.0.1/${BASH_REMATCH[1]}") 2>/dev/null && fail "the server lives on"
"$1" view nobody.vtu >/dev/null 2>err.txt && fail "a file that is not there was shown"
grep -q 'nobody.vtu' err.txt || fail "the complaint does not name the file"
echo "view: shown and gone"
