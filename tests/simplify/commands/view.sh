#!/usr/bin/env bash
# `qtet view` of a mesh and of a log. A URL is printed, the log is served there, and a signal ends
# it all and leaves nothing behind.
#   view.sh QTET-PROGRAM FOLDER-TO-WRITE-TO
set -euo pipefail
mkdir -p "$2/temporary"
cd "$2"
export TMPDIR=$PWD/temporary
qtet=$1
fail() { echo "view: $1" >&2; cat err.txt >&2; exit 1; }
view=
trap '[[ -z $view ]] || kill $view 2>/dev/null || true' EXIT

isAlive() { kill -0 $view 2>/dev/null || fail "it ended"; }

# showsAndGoes FILE NAME-IN-THE-URL OPTIONS...
showsAndGoes() {
  rm -f url.txt  # of an earlier run
  env -u DISPLAY -u WAYLAND_DISPLAY "$qtet" view "$1" "${@:3}" >url.txt 2>err.txt &
  view=$!
  until [[ -s url.txt && $(wc -l <url.txt) -gt 0 ]]; do isAlive; sleep 0.1; done
  url=$(<url.txt)
  [[ $url =~ ^http://127\.0\.0\.1:([0-9]+)/\?mesh=$2$ ]] || fail "the URL is '$url'"
  port=${BASH_REMATCH[1]}
  exec 3<>"/dev/tcp/127.0.0.1/$port"
  printf 'GET /v1/meshes/%s HTTP/1.0\r\nHost: localhost\r\n\r\n' "$2" >&3
  grep -q '"tetrahedra":3072' <&3 || fail "$1 is not served"
  [[ -n $(ls temporary) ]] || fail "the log lies elsewhere"
  kill -TERM $view
  wait $view || fail "it ended with $?"
  view=
  [[ -z $(ls temporary) ]] || fail "left behind: $(ls temporary)"
  (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null && fail "the server lives on"
  return 0
}

"$qtet" sample box -o "a box.vtu" >/dev/null
showsAndGoes "a box.vtu" a_box
cp "a box.vtu" odd.dat
showsAndGoes odd.dat odd --format vtu --weld 1e-9 --fields none
"$qtet" simplify "a box.vtu" -o ready.qtet >/dev/null 2>&1
before=$(sha256sum ready.qtet)
showsAndGoes ready.qtet ready
[[ $(sha256sum ready.qtet) == "$before" ]] || fail "the log that was shown is another one now"
"$qtet" view nobody.vtu >/dev/null 2>err.txt && fail "a file that is not there was shown"
grep -q 'nobody.vtu' err.txt || fail "the complaint does not name the file"

# Killed while it still simplifies, it leaves nothing either, nor while a program reads for it what
# we do not; and the program goes, too.
# leavesNothing SIGNAL PATTERN COMMAND...: the signal comes when a file of the pattern is there
leavesNothing() {
  local signal=$1 pattern=$2
  shift 2
  "$@" >url.txt 2>err.txt &
  view=$!
  until compgen -G "$pattern" >/dev/null; do isAlive; sleep 0.02; done
  [[ -n $(ls temporary) ]] || fail "$* made no folder"
  kill -"$signal" $view
  # Once it has printed a URL it serves, and ends well. It leaves nothing then, either.
  wait $view && [[ ! -s url.txt ]] && fail "$* ended well before it was killed"
  view=
  for _ in {1..600}; do [[ -n $(ls temporary) ]] || return 0; sleep 0.1; done
  fail "$* left behind: $(ls temporary)"
}
"$qtet" sample fin -o large.vtu --cells 100000 >/dev/null 2>&1
mkdir -p programs
printf '#!/bin/sh\necho $$ >reader.new\nmv reader.new reader.pid\nexec sleep 600\n' \
  >programs/python3
chmod +x programs/python3
echo "nothing that is known" >mesh.obscure
for signal in TERM KILL; do
  leavesNothing $signal 'temporary/*' "$qtet" view large.vtu --no-open
  rm -f reader.pid
  PATH=$PWD/programs:$PATH leavesNothing $signal reader.pid "$qtet" check mesh.obscure
  for _ in {1..600}; do kill -0 "$(<reader.pid)" 2>/dev/null || break; sleep 0.1; done
  kill -0 "$(<reader.pid)" 2>/dev/null && fail "the program that reads lives on"
done
echo "view: shown and gone"
