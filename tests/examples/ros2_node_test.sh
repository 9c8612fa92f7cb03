#!/usr/bin/env bash
# ros2_node_test.sh NODE PEER ETLC SPEC: runs the node over DDS, with a peer in place of ROS 2
# nodes, only on this machine's loopback; etlc reads its incident.
set -euo pipefail
node=$1 peer=$2 etlc=$3 spec=$4
box=$(mktemp -d)
trap 'rm -rf "$box"' EXIT
fail() { echo "FAILED: $*"; exit 1; }

export ROS_DOMAIN_ID=$((100 + $$ % 100))
export CYCLONEDDS_URI='<CycloneDDS><Domain>
  <General><Interfaces><NetworkInterface name="lo"/></Interfaces>
    <AllowMulticast>false</AllowMulticast></General>
  <Discovery><ParticipantIndex>auto</ParticipantIndex>
    <Peers><Peer Address="127.0.0.1"/></Peers></Discovery>
</Domain></CycloneDDS>'
"$node" "$box" 2>"$box/node.err" &
pid=$!
status=0
"$peer" >"$box/peer.out" 2>"$box/peer.err" || status=$?
kill -TERM "$pid"
wait "$pid" || fail "the node ends with $?: $(cat "$box/node.err")"
[ "$status" = 0 ] || fail "the peer ends with $status: $(cat "$box/peer.err" "$box/peer.out")"
cat "$box/peer.out"
"$etlc" incident "$box/patrol-incident-0" --spec "$spec" | grep "alarm of gives_way at step"
