#!/bin/sh
# Installs the Debian packages that dssbench needs and this machine lacks. A user who may not
# install packages gets the line to run.
set -eu
packages="g++ cmake ninja-build pkg-config binutils
  libeigen3-dev libxsimd-dev libcli11-dev libfmt-dev nlohmann-json3-dev libmuparser-dev
  zlib1g-dev libpng-dev libpugixml-dev libhdf5-dev
  libmetis-dev libsuitesparse-dev libopenblas0 libgtest-dev libbenchmark-dev
  libopenmpi-dev openmpi-bin libsimgrid-dev
  ocl-icd-opencl-dev opencl-clhpp-headers pocl-opencl-icd
  likwid
  python3-matplotlib python3-pandas python3-jsonschema python3-venv python3-pip
  ${DSS_EXTRA_PACKAGES:-}"
missing=""
for package in $packages; do
  dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' ||
    missing="$missing $package"
done
[ -n "$missing" ] || exit 0
if [ "$(id -u)" = 0 ]; then
  as_root=""
elif command -v sudo >/dev/null 2>&1 && sudo -n true 2>/dev/null; then
  as_root="sudo"
else
  echo "dssbench needs these packages; run, then try again:" \
    " sudo apt-get install -y --no-install-recommends$missing" >&2
  exit 1
fi
echo "installing:$missing"
$as_root apt-get update -qq
$as_root env DEBIAN_FRONTEND=noninteractive \
  apt-get install -y -qq --no-install-recommends $missing >/dev/null
