#!/bin/sh
# Installs the Debian packages that Nightjar needs and that are missing.
set -eu

# libqhull-dev: libmujoco-dev's CMake files name its folder but do not depend on it.
packages="g++ cmake ninja-build pkg-config libmujoco-dev libqhull-dev libosmesa6-dev
  libopencv-dev libapriltag-dev libeigen3-dev liblcm-dev liblcm-bin libyaml-cpp-dev libcli11-dev
  nlohmann-json3-dev libfmt-dev libspdlog-dev libssl-dev libgtest-dev libgmock-dev
  libbenchmark-dev libflatbuffers-dev flatbuffers-compiler liblz4-dev libzstd-dev python3-numpy jq
  gnuplot-nox iproute2"

fail() {
  echo "setup: $*" >&2
  exit 1
}

command -v dpkg-query >/dev/null || fail "this is no Debian; install by hand: $packages"

missing=
for package in $packages; do
  status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null) || status=
  [ "$status" = installed ] || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

if [ "$(id -u)" = 0 ]; then
  sudo=
else
  command -v sudo >/dev/null || fail "not root and no sudo; as root: apt-get install$missing"
  sudo=sudo
fi

echo "setup: installing$missing"
$sudo apt-get update -qq || fail "apt-get update did not work"
# shellcheck disable=SC2086  # one word a package
$sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing ||
  fail "apt-get could not install:$missing"
