#!/bin/sh
# For `make test-aarch64`: installs the cross compiler and the emulator, and unpacks the libraries
# for aarch64 into build/aarch64-packages. The libraries are not installed: Debian's
# libmuparser-dev:arm64 would remove the host's. apt uses lists of its own here, so that this needs
# no root and leaves the machine's architectures as they are.
set -eu
DSS_EXTRA_PACKAGES="g++-aarch64-linux-gnu qemu-user" ./cmake/install_packages.sh

libraries="libfmt-dev libmuparser-dev libbenchmark-dev
  zlib1g-dev libpng-dev libpugixml-dev libhdf5-dev"
folder=$PWD/build/aarch64-packages
[ -e "$folder/complete" ] && exit 0
rm -rf "$folder"
mkdir -p "$folder/apt/lists/partial" "$folder/apt/cache/archives/partial"
apt="-qq -o APT::Architecture=arm64 -o APT::Architectures=arm64
  -o Dir::State::Lists=$folder/apt/lists -o Dir::Cache=$folder/apt/cache -o APT::Sandbox::User="
apt-get $apt update
# A -dev package holds headers and links; the libraries are what it depends on, directly or not. The
# cross compiler has those of the languages.
needed=$(apt-cache $apt depends --recurse --no-recommends --no-suggests --no-conflicts --no-breaks \
  --no-replaces --no-enhances $libraries | grep -E '^z?lib' |
  grep -vE '^lib(c6|c-dev-bin|gcc|stdc|crypt-dev|nsl|tirpc)' | sed 's/:arm64//' | sort -u)
(cd "$folder/apt" && apt-get $apt download $libraries $needed)
for package in "$folder"/apt/*.deb; do dpkg -x "$package" "$folder"; done
rm -r "$folder/apt"
touch "$folder/complete"
