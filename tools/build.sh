#!/bin/sh
# Builds the release preset; work that is done is not done again.
set -eu
cd "$(dirname "$0")/.."

[ -f build/release/build.ninja ] || cmake --preset release
cmake --build --preset release
