#!/usr/bin/env bash
# Prints a port of this machine that nobody listens on, for a program that takes one as an option.
# The port lies below the kernel's range for outgoing connections, so none of them can take it.
# Tests that run side by side get different ports: a file claims each port for an hour. Another
# program may still take the port; start again with a new one then.
set -euo pipefail
read -r outgoing _ </proc/sys/net/ipv4/ip_local_port_range
first=10000
((outgoing > first + 1000)) || first=1024
((outgoing > first + 1000)) || { first=1024 outgoing=65536; }  # the kernel may use nearly all
claims=${TMPDIR:-/tmp}/qtet-test-ports-$UID
mkdir -p "$claims"
find "$claims" -type f -mmin +60 -delete 2>/dev/null || true
set -o noclobber
for _ in {1..1000}; do
  port=$((first + (RANDOM * 32768 + RANDOM) % (outgoing - first)))
  { : >"$claims/$port"; } 2>/dev/null || continue
  (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null && continue
  echo "$port"
  exit 0
done
echo "free_port: a thousand ports from $first to $((outgoing - 1)) are claimed in $claims" >&2
exit 1
