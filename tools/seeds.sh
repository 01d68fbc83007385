#!/bin/sh
# Flies the landing once for every seed FIRST to LAST (default 1 to 10), two at a
# time, without video, and prints a Markdown table of the results.
#   tools/seeds.sh [FIRST [LAST]]
# Exit code: 0 when every run passed, 1 when one did not, 2 when one did not end.
set -eu
cd "$(dirname "$0")/.."

tools/setup.sh
tools/build.sh
first=${1:-1}
last=${2:-10}
out=out/seeds
mkdir -p "$out"

# Exit codes are read from the summaries; the logs, half a gigabyte each, are not kept.
seq "$first" "$last" | xargs -P 2 -I{} sh -c '
  build/release/bin/nightjar run scenarios/tracking_landing.yaml --out '"$out"'/{} --seed {} \
    --no-video --quiet 2>'"$out"'/{}.log || true
  rm -f '"$out"'/{}/run.lcm'

echo "| seed | landed | touchdown error m | detection rate | straight | turning | landing | false | rmse m | passed |"
echo "|---|---|---|---|---|---|---|---|---|---|"
code=0
for seed in $(seq "$first" "$last"); do
  summary=$out/$seed/summary.json
  if [ ! -f "$summary" ]; then
    echo "| $seed | did not end: $(tail -n 1 "$out/$seed.log") |"
    code=2
    continue
  fi
  jq -r '
    def share: if .pictures == 0 then "-" else (1000 * .detections / .pictures | round / 1000) end;
    def three: if . == null then "-" else (1000 * . | round / 1000) end;
    "| \(.seed) | \(if .landed then "yes" else "no" end) | \(.touchdown_error_m | three) |"
    + " \(.detection_rate | three) | \(.phases.straight | share) | \(.phases.turning | share) |"
    + " \(.phases.landing | share) | \(.false_detections) |"
    + " \(.relative_position_rmse_m | three) | \(if .passed then "yes" else "no" end) |"' "$summary"
  [ "$(jq .passed "$summary")" = true ] || [ "$code" -eq 2 ] || code=1
done
exit "$code"
