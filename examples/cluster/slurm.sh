#!/bin/sh
# A study as a Slurm job array of one core each: sbatch --export=ALL,SCENE=dot.yaml,OUT=dot.nc examples/cluster/slurm.sh
# Submit it again after a crash: each task goes on where it stopped. Afterwards:
#     deaspice merge dot.yaml dot.nc.part-*.dea -o dot.nc
#SBATCH --job-name=deaspice
#SBATCH --array=1-100
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=1
#SBATCH --time=04:00:00
set -eu
PARTS=${PARTS:-100} # the end of --array; not SLURM_ARRAY_TASK_COUNT, which is smaller where only some tasks are submitted again
exec srun "${DEASPICE:-deaspice}" run "$SCENE" ${OPTIONS:-} -j "${SLURM_CPUS_PER_TASK:-1}" --resume --quiet \
    --shard "$SLURM_ARRAY_TASK_ID/$PARTS" -o "$OUT.part-$SLURM_ARRAY_TASK_ID.dea"
