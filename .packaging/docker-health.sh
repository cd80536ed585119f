#!/bin/bash
# Whether the container's server answers, wherever its settings make it listen: its own words,
# environment and --config are read once more by --check-config.
#   docker-health.sh [PID]      0 = it answers; of HTTPS only that it does, in words, is asked
set -euo pipefail
pid=${1:-$(pidof -s qtet-server)}
mapfile -d '' words <"/proc/$pid/cmdline"
settings=$("${words[@]}" --check-config)
setting() { sed -n "s/^$1 = //p" <<<"$settings"; }
address=$(setting admin)  # where alone /livez is answered, never with TLS
certificate=
[[ -n $address ]] || {
  address=$(setting host):$(setting port)
  certificate=$(setting tls-certificate)
}
host=${address%:*} port=${address##*:}
host=${host#[} host=${host%]}
case $host in  # all addresses: the own one is among them
  0.0.0.0) host=127.0.0.1 ;;
  ::) host=::1 ;;
esac
exec 3<>"/dev/tcp/$host/$port"
printf 'GET /livez HTTP/1.0\r\nHost: localhost\r\n\r\n' >&3
read -r _ status _ <&3
# A port with TLS says 400 to plain HTTP.
[[ $status == 200 || ($status == 400 && -n $certificate) ]]
