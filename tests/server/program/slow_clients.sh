#!/bin/sh
# Slow heads, slow bodies and slow reading by slowhttptest, against a qtet-server that must go on
# answering others at once.
#   slow_clients.sh FOLDER_OF_PROGRAMS SCRATCH      exit code 77: slowhttptest or curl is missing
set -eu
bin=$1 out=$2
command -v slowhttptest > /dev/null && command -v curl > /dev/null || {
  echo "skipped: needs Debian's slowhttptest and curl"
  exit 77
}
rm -rf "$out" && mkdir -p "$out/logs"
"$bin/qtet" sample fin -o "$out/fin.vtu" > /dev/null
"$bin/qtet" simplify "$out/fin.vtu" -o "$out/logs/fin.qtet" > /dev/null 2>&1
token=aSecretOfTwentyTwoChars
echo "write * $token" > "$out/tokens"
"$bin/qtet-server" "$out/logs" --port 0 --max-connections-per-address 0 --tokens "$out/tokens" \
  > "$out/stdout" 2> "$out/stderr" &
server=$!
trap 'kill $server 2> /dev/null || true' EXIT
until grep -q listening "$out/stdout"; do sleep 0.1; done
url=$(sed -n 's/.*listening on \(http[^ ]*\) .*/\1/p' "$out/stdout")
redirect=$(curl -s -o /dev/null -w '%{redirect_url}' "${url}v1/meshes/fin/log")
log="${url%/}$(echo "$redirect" | sed 's,^http://[^/]*,,')"

held() { curl -s -m 60 "${url}metrics" | sed -n 's/^qtet_connections_open //p'; }
# NAME, how many connections it is to hold, options of slowhttptest; others must be answered while
# it holds its connections, however slow the machine is.
attack() {
  name=$1 least=$2 answered=0 attacker=
  shift 2
  while [ $answered -lt 20 ]; do
    # The server gives up on slow clients in the end, and then it attacks again.
    if ! kill -0 $attacker 2> /dev/null; then
      slowhttptest -c 300 -r 300 -l 30 "$@" > "$out/$name.txt" 2>&1 &
      attacker=$!
    fi
    status=$(curl -s -m 60 -o /dev/null -w '%{http_code}' "${url}v1/meshes/fin") || status=none
    [ "$status" = 200 ] || { echo "$name: another client's answer was $status"; exit 1; }
    [ "$(held)" -lt $least ] || answered=$((answered + 1))
  done
  kill $attacker
  wait $attacker || true
  echo "$name: $answered others were answered while it held $least connections or more"
}

attack head 250 -H -i 1 -x 24 -t GET -u "${url}v1/meshes"
attack body 4 -m "*/*$(printf '\r\nAuthorization: Bearer %s' $token)" -B -i 1 -s 8192 -x 10 \
  -t PUT -u "${url}v1/meshes/fin"
attack read 250 -X -w 512 -y 1024 -n 1 -z 32 -k 1 -u "$log"
kill -TERM $server
wait $server
