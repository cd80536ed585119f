#!/usr/bin/env bash
# /metrics of a server that has answered requests of all kinds is read by promtool without a word.
#   metrics.sh FOLDER_OF_PROGRAMS SCRATCH      exit code 77: promtool (Debian: prometheus) or curl
#   is missing
set -euo pipefail
bin=$1 out=$2
command -v promtool >/dev/null && command -v curl >/dev/null || {
  echo "skipped: needs promtool (Debian's prometheus) and curl"
  exit 77
}
fail() { echo "metrics: $1" >&2; exit 1; }
# Fails where promtool complains, or says anything.
judge() {
  local said
  said=$(promtool check metrics <"$1" 2>&1) && [[ -z $said ]] || { echo "$said" >&2; return 1; }
}

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
ask -L "${url}v1/meshes/fin/preview.png"
ask -X OPTIONS "${url}v1/meshes/fin"
ask -X $'S"URPRISE' "${url}v1/meshes"
ask -X SURPRISE "${url}v1/meshes/%22%0A"
ask -X POST -H "Authorization: Bearer $token" "${url}v1/tickets"
ask -T "$out/logs/fin.qtet" "${url}v1/meshes/copy"
ask -T "$out/logs/fin.qtet" -H "Authorization: Bearer $token" "${url}v1/meshes/copy"
ask -T "$out/tokens" -H "Authorization: Bearer $token" "${url}v1/meshes/broken"
ask -X DELETE -H "Authorization: Bearer $token" "${url}v1/meshes/copy"
curl -s -m 60 "${url}metrics" >"$out/metrics"

judge "$out/metrics" || fail "promtool complains of $out/metrics"
for line in 'qtet_build_info{version="[^"]*"} 1' 'qtet_uploads_failed_total 2' \
  'qtet_refusals_total{reason="auth"} 1' 'qtet_refusals_total{reason="credit"} 0' \
  'qtet_refusals_total{reason="places"} 0' 'qtet_disk_free_bytes [0-9]*' \
  'qtet_uploads_part_bytes 0' 'qtet_cache_bytes{cache="pages"} [1-9][0-9]*' \
  'qtet_cache_bytes{cache="levels"} [1-9][0-9]*' 'qtet_cache_bytes{cache="copies"} [1-9][0-9]*' \
  'qtet_http_request_duration_seconds_bucket{route="mesh",method="PUT",le="0.005"} [0-9]*' \
  'qtet_http_request_duration_seconds_count{route="level",method="GET"} [1-9][0-9]*' \
  'qtet_http_request_duration_seconds_count{route="preview",method="GET"} [1-9][0-9]*' \
  'process_virtual_memory_bytes [0-9]*'; do
  grep -qx "$line" "$out/metrics" || fail "no line like $line in $out/metrics"
done
! grep -q SURPRISE "$out/metrics" || fail "a client's word became a label"
# A warning is a failure: a figure without its help.
grep -v '^# HELP qtet_meshes ' "$out/metrics" >"$out/warned"
! judge "$out/warned" 2>/dev/null || fail "a warning of promtool was not noticed"

# The dashboard and the alert rules ask for nothing that the server does not say.
here=$(dirname "${BASH_SOURCE[0]}")
deploy=$here/../../../server/deploy
for file in grafana.json alerts.yml; do
  names=$(grep -oE '\b(qtet|process)_[a-z_]+' "$deploy/$file" | sort -u)
  [[ -n $names ]] || fail "$file asks for no figure"
  for name in $names; do
    grep -qE "^$name[{ ]" "$out/metrics" || fail "$file asks for $name, which is no figure"
  done
done
promtool check rules "$deploy/alerts.yml" || fail "promtool complains of alerts.yml"
promtool test rules "$here/alerts_test.yml" || fail "an alert fires where it must not, or not"
