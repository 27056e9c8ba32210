#!/usr/bin/env bash
# Installs what the X.Org module is built with and tested with, on Debian 12 or what is like it. Does nothing twice.
# Needs root, or sudo.
#
#   ddx-shim/setup.sh           everything
#   ddx-shim/setup.sh build     what the module is built with
#   ddx-shim/setup.sh check     tells what is missing, installs nothing
set -euo pipefail

build=(xserver-xorg-core xserver-xorg-dev pkg-config gcc libc6-dev libclang1-14 libclang-common-14-dev)
# The reference driver, clients, suites.
tests=(xserver-xorg-video-dummy x11-apps x11-utils x11-xserver-utils xterm xfonts-base fonts-dejavu-core xauth twm
  xcompmgr xdotool gtk-3-examples adwaita-icon-theme)

case "${1:-all}" in
  all | check) wanted=("${build[@]}" "${tests[@]}") ;;
  build) wanted=("${build[@]}") ;;
  *)
    echo "setup.sh: $1: expected all, build or check" >&2
    exit 2
    ;;
esac

command -v dpkg-query >/dev/null || {
  echo "setup.sh: this system has no Debian packages; these are needed: ${wanted[*]}" >&2
  exit 2
}

missing=()
for package in "${wanted[@]}"; do
  state=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$state" = installed ] || missing+=("$package")
done

if [ ${#missing[@]} -eq 0 ]; then
  echo "setup.sh: everything is there"
  exit 0
fi
if [ "${1:-all}" = check ]; then
  echo "setup.sh: missing: ${missing[*]}"
  exit 1
fi

root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || {
    echo "setup.sh: packages are installed by root, and there is no sudo; missing: ${missing[*]}" >&2
    exit 2
  }
  root=(sudo)
fi
echo "setup.sh: installing ${missing[*]}"
# Lists may be old or not there at all.
"${root[@]}" apt-get update -qq
"${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
echo "setup.sh: done"
