#!/bin/sh
# From the last event of a packet to the setpoint: flies scenarios/busy.yaml, unless a flight with
# its events is there from before, and replays it in real time, 100 packets a second of 50,000
# events, through the processes of a vehicle. Each says at its end how long after the source had
# the packet it was done with it; the tracker's is the whole way.
#   tools/latency.sh [COMMAND...]      COMMAND starts each process: sudo tools/latency.sh chrt -f 10
# Use an otherwise idle machine, or such a priority. The processes talk in a network of their
# own, which the kernel must let users make.
set -eu
cd "$(dirname "$0")/.."

nightjar=build/release/bin/nightjar
[ -x $nightjar ] || tools/build.sh
flight=out/busy
if [ ! -s $flight/summary.json ] || ! grep -aqsF NIGHTJAR_EVENTS $flight/run.lcm; then
  $nightjar run scenarios/busy.yaml --out $flight --record-events --no-video --quiet || [ $? = 1 ]
fi
jq -r '"\(.event_rate_hz / 1e4 | round / 100) million events a second, \(.pictures) pictures"' \
  $flight/summary.json

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cat >"$work/loop.sh" <<'EOF'
nightjar=$1 flight=$2 work=$3
shift 3
ip link set lo up && ip link set lo multicast on && ip route add 224.0.0.0/4 dev lo
heard() { until [ -s "$1" ]; do sleep 0.05; done; }
"$@" $nightjar reconstruct --lcm scenarios/busy.yaml >"$work/r" 2>"$work/r.err" & r=$!
"$@" $nightjar track scenarios/busy.yaml >"$work/t" 2>"$work/t.err" & t=$!
heard "$work/r.err"
heard "$work/t.err"
"$@" $nightjar replay $flight/run.lcm 2>"$work/s.err" || cat "$work/s.err" >&2
kill -INT $r $t
wait
cat "$work/r" "$work/t"
EOF
user=
[ "$(id -u)" = 0 ] || user="--user --map-root-user"
unshare $user --net --pid --fork --kill-child sh "$work/loop.sh" $nightjar $flight "$work" "$@"
