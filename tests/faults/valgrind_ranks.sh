#!/bin/sh
# Runs two ranks under valgrind, with each halo strategy: no invalid access, and no branch or output
# that depends on a number that was never set.
#
#   valgrind_ranks.sh PROGRAM
#
# Valgrind knows no AVX-512, so the ranks take avx2. Two files suppress reports of Open MPI itself:
# its own, and openmpi.supp.
set -eu
program=$1
own=$(dirname "$0")/openmpi.supp
for halo in sendrecv overlap deep deep-overlap shared; do
  echo "halo $halo"
  mpirun --allow-run-as-root --oversubscribe -n 2 \
    valgrind --quiet --error-exitcode=9 --suppressions="$own" \
    --suppressions=/usr/share/openmpi/openmpi-valgrind.supp \
    "$program" run plate_paper --set n=12 --steps 3 --variant avx2 --halo "$halo" >/dev/null
done
