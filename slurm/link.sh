# One link of a chain of jobs that together do one run; sourced by run.sbatch, resume.sbatch and sweep.sbatch.
#
# A link starts raceway, hands it the signals of Slurm, waits, and decides by its exit code: 0 done, 75 stopped early,
# to be continued, anything else the end of the chain. DIR.links tells what every link did.
set -uo pipefail

# Links in a row that may end at the step they began with; a signal can come up to a minute early, even at once.
max_stalled=2
stopped_early=75
# Exit code of a shell's child that USR1 killed: raceway had not come as far as listening.
killed_by_usr1=138
# Seconds that mpirun leaves ranks to finish and save a step when their job is cancelled. Slurm itself kills after KillWait, 30
# by default, and mpirun takes half as long again to end.
save_seconds=15
said_to_stop= ended= signalled=

program() {
    echo "${RACEWAY:-$root/target/release/raceway}"
}

say() {
    echo "link: $*" >&2
}

# Number of this link in its chain, from 0: a requeued job counts for itself, a chained one is told.
link_number() {
    echo $((${SLURM_RESTART_COUNT:-0} + ${RACEWAY_LINK:-0}))
}

continues() {
    [ "$(link_number)" -gt 0 ]
}

# Number of the newest step among the files of one folder, packed or not; -1 when there is none.
newest_file() {
    local newest=-1 name number
    for name in "$1"/step_*.hdf "$1"/pack_*.hdf; do
        number=${name##*_}
        number=${number%.hdf}
        [[ "$number" =~ ^[0-9]+$ && -e "$name" ]] || continue
        number=$((10#$number))
        [ "$number" -le "$newest" ] || newest=$number
    done
    echo "$newest"
}

# Number of the newest step of a run; of a list of bearings, whose folder has the scene and a folder for each of them,
# the newest one that all have. none when there is none.
newest_step() {
    local newest=-1 own= bearing number
    if [ -e "$1/scene.toml" ]; then
        for bearing in "$1"/*/mesh.hdf; do
            bearing=${bearing%/mesh.hdf}
            [[ -d "$bearing" && "${bearing##*/}" != superseded_* ]] || continue
            number=$(newest_file "$bearing")
            [[ -n "$own" && "$number" -ge "$newest" ]] || newest=$number
            own=yes
        done
    else
        newest=$(newest_file "$1")
    fi
    [ "$newest" -ge 0 ] || newest=none
    echo "$newest"
}

# Whether a run that has stopped can be gone on with: the points of a sweep that are left are a run of their own.
is_resumable() {
    ! grep -qs '^ *"analysis": *"sweep"' "$1/summary.json"
}

# Whether as many links as may have begun at this step, one after the other.
is_stalled() {
    local log="$1" step="$2"
    [ -e "$log" ] || return 1
    awk -v step="$step" -v most="$max_stalled" '
        $1 == "chain" { stalled = 0 }
        $1 == "start" { stalled = $NF == step ? stalled + 1 : 0 }
        END { exit !(stalled >= most) }' "$log"
}

# Those of the options of sbatch that say who pays and where jobs run, in the array account: a site may refuse the job of
# a table without them.
account_options() {
    account=()
    while [ $# -gt 0 ]; do
        case "$1" in
            --account=* | --partition=* | --qos=* | --reservation=* | --clusters=* | -[ApqM]?*) account+=("$1") ;;
            --account | --partition | --qos | --reservation | --clusters | -[ApqM])
                [ $# -lt 2 ] || account+=("$1" "$2")
                shift
                ;;
        esac
        [ $# -eq 0 ] || shift
    done
}

# Command that starts the ranks, in the array launcher; empty for one rank.
choose_launcher() {
    local ranks="${SLURM_NTASKS:-1}"
    launcher=()
    [ "$ranks" -gt 1 ] || return 0
    if [ -n "${RACEWAY_LAUNCHER:-}" ]; then
        read -r -a launcher <<< "$RACEWAY_LAUNCHER"
    elif command -v mpirun > /dev/null; then
        # Open MPI would tie a rank and all its threads to one core.
        launcher=(mpirun -n "$ranks")
        if mpirun --version 2> /dev/null | grep -q "Open MPI"; then
            launcher+=(--bind-to none)
            # A job that is cancelled gets SIGTERM in all its processes; mpirun would kill the ranks a second later, in the
            # middle of their step. (Names of the setting before and from Open MPI 5 on.)
            export OMPI_MCA_odls_base_sigkill_timeout=${OMPI_MCA_odls_base_sigkill_timeout:-$save_seconds}
            export PRTE_MCA_odls_base_sigkill_timeout=${PRTE_MCA_odls_base_sigkill_timeout:-$save_seconds}
        fi
    else
        launcher=(srun)
    fi
    # From Slurm 22.05 on srun does not take over --cpus-per-task: all threads of a rank would share one core. (mpirun,
    # which starts its own daemons by srun, gets none of it: their ranks would share the cores of one.)
    if [ "${launcher[0]##*/}" = srun ]; then
        export SRUN_CPUS_PER_TASK=${SRUN_CPUS_PER_TASK:-${SLURM_CPUS_PER_TASK:-1}}
    fi
    command -v "${launcher[0]}" > /dev/null || {
        say "$ranks ranks need a launcher, and ${launcher[0]} is not on the PATH; set RACEWAY_LAUNCHER"
        exit 2
    }
}

# Passes a signal on to raceway, or to the launcher, which passes it to the ranks. On TERM, mpirun would kill them; on a second one, after
# that which Slurm sends to all processes of a cancelled job, at once. USR1 stops ranks as well.
forward() {
    signalled=yes
    local signal="$1"
    [ ${#launcher[@]} -eq 0 ] || signal=USR1
    kill -s "$signal" "$child" 2> /dev/null
}

# Starts a command, hands it USR1 and TERM, and leaves its exit code in code.
run_with_signals() {
    child=
    trap 'said_to_stop=yes; [ -z "$child" ] || forward USR1' USR1
    trap 'ended=yes; [ -z "$child" ] || forward TERM' TERM
    "$@" &
    child=$!
    # A signal that came before there was a child.
    [ -z "$said_to_stop" ] || forward USR1
    [ -z "$ended" ] || forward TERM
    code=0
    wait "$child" || code=$?
    # A trap ends the wait, not the child.
    while [ -n "$signalled" ]; do
        signalled=
        wait "$child"
        local again=$?
        # The child had ended before the trap came: the first answer holds.
        [ "$again" -eq 127 ] || code=$again
    done
    trap '' USR1
}

# Puts this job, or a new one, into the queue.
continue_chain() {
    local script="$1"
    shift
    case "${RACEWAY_CONTINUE:-requeue}" in
        no)
            say "stopped early; go on with: sbatch slurm/resume.sbatch $dir"
            exit "$stopped_early"
            ;;
        requeue)
            # Slurm ends this script; waiting, it can be ended.
            trap - TERM
            if scontrol requeue "$SLURM_JOB_ID"; then
                sleep 300 &
                wait $!
            fi
            say "Slurm did not requeue the job; go on with: sbatch slurm/resume.sbatch $dir"
            exit "$stopped_early"
            ;;
        chain)
            chain_next "$script" "$@"
            ;;
    esac
}

# Submits the next link with the resources of this one, to start when it has ended.
chain_next() {
    local script="$1" limit log next
    shift
    limit=$(squeue -h -j "$SLURM_JOB_ID" -o %l)
    # One log for the whole chain; its name may have spaces.
    log=$(scontrol show job "$SLURM_JOB_ID" | sed -n 's|^ *StdOut=||p')
    local resources=(--ntasks="${SLURM_NTASKS:-1}" --cpus-per-task="${SLURM_CPUS_PER_TASK:-1}" --time="$limit"
        --job-name="$SLURM_JOB_NAME" --output="${log:-raceway-%j.log}")
    [ -z "${SLURM_JOB_PARTITION:-}" ] || resources+=(--partition="$SLURM_JOB_PARTITION")
    [ -z "${SLURM_JOB_ACCOUNT:-}" ] || resources+=(--account="$SLURM_JOB_ACCOUNT")
    [ -z "${SLURM_JOB_QOS:-}" ] || resources+=(--qos="$SLURM_JOB_QOS")
    [ -z "${SLURM_JOB_RESERVATION:-}" ] || resources+=(--reservation="$SLURM_JOB_RESERVATION")
    [ -z "${SLURM_MEM_PER_NODE:-}" ] || resources+=(--mem="$SLURM_MEM_PER_NODE")
    [ -z "${SLURM_MEM_PER_CPU:-}" ] || resources+=(--mem-per-cpu="$SLURM_MEM_PER_CPU")
    # What no variable of a job tells, such as --signal.
    local more=()
    read -r -a more <<< "${RACEWAY_CHAIN_OPTIONS:-}"
    resources+=("${more[@]}")
    next=$(RACEWAY_LINK=$(($(link_number) + 1)) sbatch --parsable --dependency=afterany:"$SLURM_JOB_ID" \
        --kill-on-invalid-dep=yes "${resources[@]}" "$root/slurm/$script" "$@") || {
        say "sbatch did not take the next link; go on with: sbatch slurm/resume.sbatch $dir"
        exit "$stopped_early"
    }
    say "job $next goes on"
    exit 0
}

# link SCRIPT DIR SUBCOMMAND [ARGUMENT]... -- [ARGUMENTS OF SCRIPT]...
link() {
    local script="$1" dir="$2" begun command=() log
    shift 2
    while [ $# -gt 0 ] && [ "$1" != -- ]; do
        command+=("$1")
        shift
    done
    shift
    case "${RACEWAY_CONTINUE:-requeue}" in
        no | requeue | chain) ;;
        *) say "RACEWAY_CONTINUE is $RACEWAY_CONTINUE; expected requeue, chain or no"; exit 2 ;;
    esac
    [ -x "$(program)" ] || {
        say "$(program) is not there; build it (cargo build --release) or set RACEWAY to the program"
        exit 2
    }
    choose_launcher
    dir=${dir%/}
    log=$dir.links
    mkdir -p "$(dirname "$log")" || exit 2
    [ ! -L "$log" ] || { say "$log is a link, and nothing is written through one; remove it"; exit 2; }
    begun=$(newest_step "$dir")
    continues || echo "chain of job ${SLURM_JOB_ID:-none}" >> "$log"
    if is_stalled "$log" "$begun"; then
        say "$max_stalled links in a row did not get beyond step $begun; give them more time (--time) and submit again"
        echo "end stalled" >> "$log"
        exit 1
    fi
    echo "start job ${SLURM_JOB_ID:-none} link $(link_number) ranks ${SLURM_NTASKS:-1} threads" \
        "${SLURM_CPUS_PER_TASK:-1} ${command[0]} from step $begun" >> "$log"
    run_with_signals "${launcher[@]}" "$(program)" --threads "${SLURM_CPUS_PER_TASK:-1}" "${command[@]}"
    echo "end exit code $code at step $(newest_step "$dir")" >> "$log"
    if [ -n "$said_to_stop" ] && [ "$code" -eq "$killed_by_usr1" ]; then
        say "the signal came before the first step"
        code=$stopped_early
    fi
    if [ "$code" -eq "$stopped_early" ] && ! is_resumable "$dir"; then
        say "the sweep stopped early and keeps the points that it has; a new run solves the others, with --points"
        exit "$stopped_early"
    fi
    if [ "$code" -eq "$stopped_early" ] && [ -z "$ended" ]; then
        continue_chain "$script" "$@"
    fi
    [ "$code" -eq 0 ] || say "raceway ended with exit code $code at step $(newest_step "$dir"); the chain ends here"
    exit "$code"
}
