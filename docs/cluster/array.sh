#!/usr/bin/env bash
# One task of a Slurm job array plays one shard of an evaluation, of matches or of learning; without an array,
# and with `merge` in front, the shards are put together. docs/cluster.md.
#
#   job=$(sbatch --parsable --array=1-8 docs/cluster/array.sh evaluate --trials 500 --out results)
#   sbatch --dependency="afterany:$job" docs/cluster/array.sh merge evaluate --trials 500 --out results
#
# ONETWO          the program; by default `onetwo` in PATH
# ONETWO_SHARDS   number of shards, where only some tasks of an array are submitted again
#
#SBATCH --job-name=onetwo
#SBATCH --requeue
#SBATCH --open-mode=append
set -euo pipefail

onetwo=${ONETWO:-onetwo}

fail() {
    echo "array.sh: $1" >&2
    exit 2
}

# The value of --out (also -o DIR, --out=DIR), and whether --jobs is given.
read_options() {
    out='' jobs=''
    while (($#)); do
        case $1 in
            --out | -o) out=${2:-} ;;
            --out=*) out=${1#--out=} ;;
            -o?*) out=${1#-o} out=${out#=} ;;
            --jobs | --jobs=* | -j*) jobs=given ;;
            --shard | --shard=*) fail "--shard comes from the array; leave it out" ;;
            --fresh) fail "--fresh would drop finished trials when a task is repeated; name an empty directory" ;;
        esac
        shift
    done
    [[ -n $out ]] || fail "name a directory that all tasks can write to: --out DIR"
}

shard() {
    read_options "$@"
    local of=${ONETWO_SHARDS:-$SLURM_ARRAY_TASK_COUNT}
    local first=${SLURM_ARRAY_TASK_MIN:-0} last=${SLURM_ARRAY_TASK_MAX:-0}
    if [[ -z ${ONETWO_SHARDS:-} && ($first != 1 || $last != "$of") ]]; then
        fail "the array is not 1 to N: submit --array=1-N, or set ONETWO_SHARDS=N for some tasks of it"
    fi
    if [[ -z $jobs ]]; then
        set -- "$@" --jobs "${SLURM_CPUS_PER_TASK:-${SLURM_CPUS_ON_NODE:-1}}"
    fi
    # The program replaces the shell, so that Slurm's signals reach it.
    exec "$onetwo" "$@" --shard "$SLURM_ARRAY_TASK_ID/$of"
}

merge() {
    read_options "$@"
    local command=("$@") errors status=0
    case "$1 ${2:-}" in
        "evaluate matches") command+=(--merge "$out") ;;
        # Learning reads all journals of its directory, and plays what no shard has played.
        "cases learn") ;;
        "evaluate "*)
            command=(evaluate merge "$out" --out "$out")
            shift
            while (($#)); do
                case $1 in
                    --maps) command+=("$1" "${2:-}") ;;
                    --maps=* | --png) command+=("$1") ;;
                esac
                shift
            done
            ;;
        *) fail "merge evaluate …, merge evaluate matches … or merge cases learn …, with the array's options" ;;
    esac
    errors=$(mktemp)
    "$onetwo" "${command[@]}" 2>"$errors" || status=$?
    cat "$errors" >&2
    lacking "$errors"
    rm -f "$errors"
    exit "$status"
}

# The commands that play the shards which the program reports as lacking.
lacking() {
    local script=$0 index of
    if [[ -n ${SLURM_JOB_ID:-} ]] && command -v scontrol >/dev/null; then
        # Slurm runs a copy; the job knows where it came from.
        script=$(scontrol show job "$SLURM_JOB_ID" | sed -n 's/^ *Command=\([^ ]*\).*/\1/p')
    fi
    sed -n 's|^ *--shard \([0-9]*\)/\([0-9]*\): .*|\1 \2|p' "$1" | while read -r index of; do
        echo "play it: ONETWO_SHARDS=$of sbatch --array=$index $script$asked" >&2
    done
}

if [[ ${1:-} == merge ]]; then
    shift
    asked=$(printf ' %q' "$@")
    (($#)) || fail "merge what? Repeat the array's command line"
    merge "$@"
elif [[ -n ${SLURM_ARRAY_TASK_ID:-} ]]; then
    shard "$@"
else
    fail "not in a job array: sbatch --array=1-N $0 evaluate … --out DIR"
fi
