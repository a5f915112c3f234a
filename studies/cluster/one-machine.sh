#!/usr/bin/env bash
# A run in shards on one machine, or on none but this: what was done stays, and a run that was stopped goes on.
#
#   studies/cluster/one-machine.sh 8 OUT report --quick
#
# FIXED_STEP is the program (default: fixed-step on the PATH).
set -euo pipefail
count=$1 out=$2 program=$3
shift 3
fixed_step=${FIXED_STEP:-fixed-step}
parts=()
for ((k = 1; k <= count; k++)); do
    "$fixed_step" "$program" "$@" --resume --shard "$k/$count" --out "$out.shards/$k"
    parts+=("$out.shards/$k")
done
"$fixed_step" merge "${parts[@]}" --out "$out"
