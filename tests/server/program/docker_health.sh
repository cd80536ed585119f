#!/usr/bin/env bash
# The container's health check follows the settings: by option, by environment, by file, with TLS,
# with a separate operators' address. It fails if no server answers.
#   docker_health.sh FOLDER_OF_PROGRAMS SCRATCH      exit code 77: openssl is missing
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
health=$here/../../../.packaging/docker-health.sh
server=$1/qtet-server out=$2
command -v openssl >/dev/null || { echo "skipped: needs openssl"; exit 77; }
rm -rf "$out" && mkdir -p "$out/logs"
out=$(realpath "$out")
openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -days 2 \
  -subj /CN=localhost -keyout "$out/key" -out "$out/crt" 2>/dev/null
unset "${!QTET_SERVER_@}"

pid=
trap '[[ -z $pid ]] || kill "$pid" 2>/dev/null || true' EXIT
fail() { echo "docker_health: $1" >&2; exit 1; }
freePort() { "$here/../../support/free_port.sh"; }

# NAME WORDS...: starts the server that the words say. Returns 1 where its port is taken.
start() {
  local name=$1
  shift
  "$@" >"$out/$name.txt" 2>&1 &
  pid=$!
  until grep -qs 'listening on' "$out/$name.txt"; do
    kill -0 "$pid" 2>/dev/null || {
      grep -q 'in use' "$out/$name.txt" || fail "$name: $(<"$out/$name.txt")"
      return 1
    }
    sleep 0.05
  done
}

# NAME WORDS...: a server that is started so is healthy once it listens, and not when it is gone.
# PORT and ADMIN in the words, the configuration and the environment stand for free ports.
healthy() {
  local name=$1
  shift
  until
    port=$(freePort) admin=$(freePort)
    printf 'folder = %s\nport = %s\n' "$out/logs" "$port" >"$out/conf"
    [[ -z ${QTET_SERVER_PORT:-} ]] || QTET_SERVER_PORT=$port
    words=("${@//PORT/$port}")
    start "$name" "${words[@]//ADMIN/$admin}"
  do :; done
  "$health" "$pid" || fail "$name: not healthy"
  kill -STOP "$pid"
  ! timeout 1 "$health" "$pid" 2>/dev/null || fail "$name: healthy while it hangs"
  kill -CONT "$pid"
  kill "$pid" && wait "$pid"
  ! "$health" "$pid" 2>/dev/null || fail "$name: healthy when it is gone"
  echo "$name: healthy"
}

healthy option "$server" "$out/logs" --port PORT
export QTET_SERVER_HOST=0.0.0.0
healthy host "$server" "$out/logs" --port PORT
export QTET_SERVER_PORT=PORT
healthy environment "$server" "$out/logs"
healthy both "$server" "$out/logs" --port ADMIN
unset QTET_SERVER_PORT
healthy file "$server" --config "$out/conf"
healthy tls "$server" --config "$out/conf" --tls-certificate "$out/crt" --tls-key "$out/key"
healthy admin "$server" --config "$out/conf" --admin 127.0.0.1:ADMIN
