#!/bin/sh
# Installs what is missing, builds, and runs every test. The last line counts
# them: "N passed, N failed", with ", N skipped" where there are such.
set -eu
cd "$(dirname "$0")/.."

tools/setup.sh
tools/build.sh

log=build/release/ctest.log
ctest --preset release --parallel 2 --no-tests=error 2>&1 | tee "$log"

# ctest counts what it skipped among what passed.
total=$(sed -n 's/^.* tests failed out of \([0-9]*\)$/\1/p' "$log")
failed=$(sed -n 's/^.*, \([0-9]*\) tests failed out of [0-9]*$/\1/p' "$log")
skipped=$(grep -c '^ *[0-9]*/[0-9]* Test .*\*\*\*Skipped' "$log" || true)
if [ -z "$total" ]; then
  echo "test: ctest did not finish" >&2
  exit 1
fi

line="$((total - failed - skipped)) passed, $failed failed"
[ "$skipped" -eq 0 ] || line="$line, $skipped skipped"
echo "$line"
[ "$failed" -eq 0 ]
