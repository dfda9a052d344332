#!/bin/sh
# A study on all cores, and with --sshlogin on several machines that share this folder, by GNU parallel:
#     examples/cluster/parallel.sh dot.yaml dot.nc 100 --engine direct
# scene, result, parts, options of deaspice. Start it again after a crash: finished parts stay, others go on where they stopped.
set -eu
scene=$1 out=$2 parts=$3
shift 3
deaspice=${DEASPICE:-deaspice}
seq "$parts" | parallel --quote ${PARALLEL_OPTIONS:-} \
    "$deaspice" run "$scene" "$@" -j 1 --resume --quiet --shard "{}/$parts" -o "$out.part-{}.dea" || true # merge names what is missing
list() { seq -f "$out.part-%.0f.dea" "$parts" | tr '\n' '\0'; }
list | xargs -0 -x "$deaspice" merge "$scene" "$@" -o "$out"
list | xargs -0 rm -f
