#!/usr/bin/env bash
# /metrics of a server that has answered requests of all kinds is as Prometheus wants it.
#   metrics.sh FOLDER_OF_PROGRAMS SCRATCH      exit code 77: python3 or curl is missing
set -euo pipefail
bin=$1 out=$2
command -v python3 >/dev/null && command -v curl >/dev/null || {
  echo "skipped: needs python3 and curl"
  exit 77
}
fail() { echo "metrics: $1" >&2; exit 1; }
here=$(dirname "${BASH_SOURCE[0]}")
judge() { python3 "$here/exposition.py"; }

rm -rf "$out" && mkdir -p "$out/logs"
"$bin/qtet" sample fin --cells 2000 -o "$out/fin.vtu" >/dev/null
"$bin/qtet" simplify "$out/fin.vtu" -o "$out/logs/fin.qtet" >/dev/null 2>&1
token=aSecretOfTwentyTwoChars
echo "write * $token" >"$out/tokens"
"$bin/qtet-server" "$out/logs" --port 0 --tokens "$out/tokens" >"$out/stdout" 2>"$out/stderr" &
server=$!
trap 'kill $server 2>/dev/null || true' EXIT
for _ in {1..100}; do grep -q 'listening on' "$out/stdout" && break; sleep 0.1; done
url=$(sed -n 's/.*listening on \(http[^ ]*\) .*/\1/p' "$out/stdout")
ask() { curl -s -m 60 -o /dev/null "$@" || true; }

for path in '' v1/meshes v1/meshes/fin v1/meshes/none openapi.json livez readyz version \
  v1/stream; do
  ask "$url$path"
  ask -I "$url$path"
done
ask -L "${url}v1/meshes/fin/log"
ask -L "${url}v1/meshes/fin/levels/0.vtu"
ask -L "${url}v1/meshes/fin/poster.webp"
ask -X OPTIONS "${url}v1/meshes/fin"
ask -X $'S"URPRISE' "${url}v1/meshes"
ask -X SURPRISE "${url}v1/meshes/%22%0A"
ask -X POST -H "Authorization: Bearer $token" "${url}v1/tickets"
ask -T "$out/logs/fin.qtet" "${url}v1/meshes/copy"
ask -T "$out/logs/fin.qtet" -H "Authorization: Bearer $token" "${url}v1/meshes/copy"
ask -T "$out/tokens" -H "Authorization: Bearer $token" "${url}v1/meshes/broken"
ask -X DELETE -H "Authorization: Bearer $token" "${url}v1/meshes/copy"
curl -s -m 60 "${url}metrics" >"$out/metrics"

judge <"$out/metrics" || fail "$out/metrics is not as Prometheus wants it"
for line in 'qtet_build_info{version="[^"]*"} 1' 'qtet_uploads_failed_total 2' \
  'qtet_refusals_total{reason="auth"} 1' 'qtet_refusals_total{reason="credit"} 0' \
  'qtet_refusals_total{reason="places"} 0' 'qtet_disk_free_bytes [0-9]*' \
  'qtet_uploads_part_bytes 0' 'qtet_cache_bytes{cache="pages"} [1-9][0-9]*' \
  'qtet_cache_bytes{cache="levels"} [1-9][0-9]*' 'qtet_cache_bytes{cache="copies"} [1-9][0-9]*' \
  'qtet_http_request_duration_seconds_bucket{route="mesh",method="PUT",le="0.005"} [0-9]*' \
  'qtet_http_request_duration_seconds_count{route="level",method="GET"} [1-9][0-9]*' \
  'qtet_http_request_duration_seconds_count{route="poster",method="GET"} [1-9][0-9]*' \
  'process_virtual_memory_bytes [0-9]*'; do
  grep -qx "$line" "$out/metrics" || fail "no line like $line in $out/metrics"
done
! grep -q SURPRISE "$out/metrics" || fail "a client's word became a label"
# Each of these breaks one rule, on a page that was sound.
first='qtet_stream_first_frame_seconds'
for damage in '/^# HELP qtet_meshes /d' '/^# TYPE qtet_meshes /d' '/^qtet_meshes /p' \
  's/^qtet_meshes /&+ /' 's/qtet_connections_total/qtet_connections/' \
  's/{version="/&\\q/' 's/{\(version="[^"]*"\)}/{\1,\1}/' \
  "/^${first}_bucket{le=\"+Inf\"}/d" "/^${first}_sum/d" "/^${first}_count/s/ .*/ 9/" \
  "/^${first}_bucket{le=\"1\"}/s/ .*/ 9/" "/^${first}_bucket{le=\"1\"}/s/1/0.0001/" \
  '$s/.*/process_x 1/'; do
  sed "$damage" "$out/metrics" >"$out/damaged"
  ! cmp -s "$out/metrics" "$out/damaged" || fail "$damage changes nothing"
  ! judge <"$out/damaged" 2>/dev/null || fail "$damage was not noticed"
done

# The dashboard and the alert rules ask for nothing that the server does not say.
deploy=$here/../../../server/deploy
for file in grafana.json alerts.yml; do
  names=$(grep -oE '\b(qtet|process)_[a-z_]+' "$deploy/$file" | sort -u)
  [[ -n $names ]] || fail "$file asks for no figure"
  for name in $names; do
    grep -qE "^$name[{ ]" "$out/metrics" || fail "$file asks for $name, which is no figure"
  done
done
