#!/bin/sh
# Installs what is missing, builds, and flies the landing to out/demo.
#   tools/demo.sh [--seed N] [--no-video]
# The exit code is the program's: 0 passed, 1 not passed, 2 bad input, 3 our own fault
# or the disk's, 130 interrupted.
set -eu
cd "$(dirname "$0")/.."

tools/setup.sh
tools/build.sh

code=0
build/release/bin/nightjar run scenarios/tracking_landing.yaml --out out/demo "$@" || code=$?
if [ "$code" -le 1 ] && [ -f out/demo/run.mp4 ]; then
  echo "video: $PWD/out/demo/run.mp4"
fi
exit "$code"
