#!/bin/sh
# Runs every benchmark, prints each one's speed as a ratio to the plain reference that
# ran beside it, and writes all of it to one JSON file.
#   tools/bench.sh [FILE [FILTER]]      default: out/bench.json, all benchmarks
# Use an otherwise idle machine; ratios bear noise better than milliseconds.
set -eu
cd "$(dirname "$0")/.."

tools/setup.sh
tools/build.sh
file=${1:-out/bench.json}
filter=${2:-.}
mkdir -p "$(dirname "$file")"
raw=$(mktemp)
trap 'rm -f "$raw"' EXIT

# Medians of rounds that take turns, so that a busy minute hits reference and candidate.
build/release/bin/benchmarks --benchmark_filter="$filter" --benchmark_repetitions=5 \
  --benchmark_enable_random_interleaving=true --benchmark_report_aggregates_only=true \
  --benchmark_out="$raw" --benchmark_out_format=json >/dev/null

# NAME_reference is the reference of every benchmark whose name begins with NAME, and
# NAME_reference/ARGUMENT of NAME/ARGUMENT.
jq '[.benchmarks[] | select(.aggregate_name == "median")
     | {name: (.run_name | sub("(/iterations:1)?/(real|manual)_time$"; "")), time: .real_time, unit: .time_unit}] as $all
    | [$all[] | select(.name | contains("_reference"))
       | {key: (.name | sub("_reference"; "")), time}] as $references
    | {context: (.context | {date, num_cpus, mhz_per_cpu, load_avg}),
       note: "median of 5 rounds in random order; times_reference: how many times as fast",
       benchmarks: [$all[] | . as $b
         | ([$references[] | select(.key as $k | $b.name | startswith($k))][0]) as $r
         | . + {times_reference: (if $r then $r.time / .time else null end)}]}' "$raw" >"$file"

jq -r '.benchmarks[] | "\(.name)\t\(.time * 1000 | round / 1000) \(.unit)\t" +
       (if .times_reference then "\(.times_reference * 100 | round / 100) x reference" else "-" end)' \
  "$file" | column -t -s "$(printf '\t')"
echo "written to $file"
