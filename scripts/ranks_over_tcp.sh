#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Makes one mesh on ranks that share nothing but a network, and compares it with that of the ordinary command, byte for
# byte. Each rank is in a network namespace of its own, as on a machine of its own: its address on a bridge is all that
# others know of it. Needs root, iproute2 and a build with eigencrust-mpi.
# Usage: scripts/ranks_over_tcp.sh CLOUD [RANKS, default 3] [BUILD, default build]. Status 77: not possible here.
set -euo pipefail
cloud=$(realpath -- "$1") ranks=${2:-3} build=$(realpath -- "${3:-build}")
skip() {
  printf 'skipped: %s\n' "$1"
  exit 77
}
[ "$(id -u)" -eq 0 ] || skip "only root makes namespaces"
command -v ip >/dev/null || skip "there is no ip (iproute2)"
command -v mpiexec >/dev/null || skip "there is no mpiexec"

work=$(mktemp -d)
name=ec$$
clean() {
  local k
  for ((k = 1; k <= ranks; ++k)); do ip netns del "$name-$k" 2>/dev/null || true; done
  ip link del "$name" 2>/dev/null || true
  rm -rf "$work"
}
trap clean EXIT
ip link add "$name" type bridge 2>"$work/why" || skip "no bridge can be made: $(cat "$work/why")"
ip link set "$name" up
hosts=
for ((k = 1; k <= ranks; ++k)); do
  ip netns add "$name-$k"
  ip link add "$name-$k" type veth peer name eth0 netns "$name-$k"
  ip link set "$name-$k" master "$name" up
  ip -n "$name-$k" addr add "10.77.0.$k/24" dev eth0
  ip -n "$name-$k" link set eth0 up
  ip -n "$name-$k" link set lo up
  hosts+=${hosts:+,}10.77.0.$k
done

ip netns exec "$name-1" unshare --uts hostname rank1 2>"$work/why" || skip "namespaces cannot be entered: $(cat "$work/why")"

# What mpiexec takes for ssh: into the namespace of an address, under a host name of its own.
cat >"$work/enter" <<'ENTER'
#!/usr/bin/env bash
while [[ $1 == -* ]]; do shift; done
number=${1##*.}
shift
exec ip netns exec "$NAMESPACES-$number" unshare --uts sh -c "hostname rank$number; $*"
ENTER
chmod +x "$work/enter"

export NAMESPACES=$name OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
"$build/eigencrust" "$cloud" -o "$work/one.ply" -q
ip netns exec "$name-1" unshare --uts sh -c 'hostname rank1; exec "$@"' sh \
  mpiexec -n "$ranks" --host "$hosts" --mca plm rsh --mca plm_rsh_agent "$work/enter" \
  --mca oob_tcp_if_include eth0 --mca btl tcp,self --mca btl_tcp_if_include eth0 \
  "$build/eigencrust-mpi" "$cloud" -o "$work/ranks.ply" --report "$work/report.json"
cmp "$work/one.ply" "$work/ranks.ply"
printf 'the same mesh from %s ranks over TCP\n' "$ranks"
