#!/bin/bash
# A batch as a SLURM array, one part of the takes per task. See the page On a farm.
#
#   sbatch --array=1-20 slurm.sh MANIFEST OUTPUT_FOLDER VERB [OPTION ...]
#
# MOCAP_ASSIST is the command of Mocap Assist on the nodes, by default "python3 -m solvers";
# with the Python package it is mocap-assist.
#SBATCH --job-name=mocap_assist
#SBATCH --array=1-10
#SBATCH --cpus-per-task=1
#SBATCH --requeue
set -eu

if [ $# -lt 3 ]; then
    echo "Usage: sbatch --array=1-N $0 MANIFEST OUTPUT_FOLDER VERB [OPTION ...]" >&2
    exit 2
fi
if [ "$SLURM_ARRAY_TASK_COUNT" != "$SLURM_ARRAY_TASK_MAX" ]; then
    echo "The array must be 1-N: the parts of a batch are numbered without gaps." >&2
    exit 2
fi
manifest=$1 folder=$2 verb=$3
shift 3
exec ${MOCAP_ASSIST:-python3 -m solvers} "$verb" \
    --manifest "$manifest" --output-folder "$folder" \
    --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_MAX" --report --wait "$@"
