#!/usr/bin/env bash
# A Slurm cluster of one node on this machine: ordinary processes on loopback, no systemd, no cgroups, any user.
#
#   cluster.sh install        install Debian's packages if they are missing (needs root); no daemon is started
#   cluster.sh start FOLDER   start a cluster whose keys, sockets, logs and settings are all in FOLDER
#   cluster.sh node FOLDER    kill the node daemon and start it again; jobs run on meanwhile
#   cluster.sh stop FOLDER    cancel its jobs and end its processes
#
# After `start`: export SLURM_CONF=FOLDER/slurm.conf. FOLDER/finished.txt tells of every job that has ended.
set -euo pipefail
# Daemons lie where the path of an ordinary user does not lead.
PATH=$PATH:/usr/sbin:/sbin

fail() {
    echo "cluster.sh: $*" >&2
    exit 1
}

install() {
    for program in sbatch slurmctld slurmd munged; do
        command -v $program >/dev/null || missing=1
    done
    [ -n "${missing:-}" ] || return 0
    [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null || fail "slurm-wlm and munge: not installed, and only root can"
    # Debian starts daemons that it installs, unless this file forbids it.
    if [ ! -e /usr/sbin/policy-rc.d ]; then
        trap 'rm -f /usr/sbin/policy-rc.d' EXIT
        printf '#!/bin/sh\nexit 101\n' >/usr/sbin/policy-rc.d
        chmod +x /usr/sbin/policy-rc.d
    fi
    timeout 300 apt-get -qq update >/dev/null
    DEBIAN_FRONTEND=noninteractive timeout 600 apt-get -qq -y install --no-install-recommends slurm-wlm munge >/dev/null
}

# Wait up to 20 s until a command succeeds.
await() {
    for _ in $(seq 200); do
        "$@" >/dev/null 2>&1 && return 0
        sleep 0.1
    done
    return 1
}

settings() {
    local name ports
    name=$(uname -n)
    name=${name%%.*}
    # Two ports that are free now.
    ports=($(python3 -c 'import socket
taken = [socket.create_server(("127.0.0.1", 0)) for _ in range(2)]
print(*(each.getsockname()[1] for each in taken))'))
    cat <<END
ClusterName=loopback
SlurmctldHost=$name(127.0.0.1)
SlurmctldPort=${ports[0]}
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
# Else the daemons listen on every address.
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
PlugStackConfig=$folder/plugstack.conf
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/filetxt
JobCompLoc=$folder/finished.txt
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
SchedulerParameters=batch_sched_delay=0,sched_min_interval=10000
MpiDefault=none
# Else one job takes all memory.
DefMemPerCPU=200
# A job that could never start is refused.
EnforcePartLimits=ALL
MinJobAge=86400
KillWait=3
ReturnToService=2
SlurmdParameters=config_overrides
NodeName=$name NodeAddr=127.0.0.1 Port=${ports[1]} CPUs=8 RealMemory=4000 State=UNKNOWN
PartitionName=all Nodes=$name Default=YES MaxTime=INFINITE State=UP
END
}

start() {
    [ ! -e "$folder/slurm.conf" ] || fail "$folder: holds a cluster already"
    mkdir -p "$folder/state" "$folder/spool"
    chmod 755 "$folder"
    head -c 128 /dev/urandom >"$folder/munge.key"
    chmod 400 "$folder/munge.key"
    : >"$folder/plugstack.conf"
    settings >"$folder/slurm.conf"
    # A folder below /tmp is less private than munged wants it.
    munged --force --num-threads=2 --socket="$folder/munge.socket" --key-file="$folder/munge.key" \
        --pid-file="$folder/munged.pid" --log-file="$folder/munged.log" --seed-file="$folder/munged.seed"
    slurmctld
    slurmd
    await up || { tail -n 5 "$folder"/*.log >&2; stop; fail "$folder: the node did not come up in 20 s"; }
}

up() {
    sinfo --noheader --format=%T | grep -qx idle
}

node() {
    kill -KILL "$(cat "$folder/slurmd.pid")"
    await ended "$(cat "$folder/slurmd.pid")" || fail "$folder: the node daemon does not end"
    slurmd
}

ended() {
    ! kill -0 "$1"
}

idle() {
    [ -z "$(squeue --noheader)" ]
}

stop() {
    [ -e "$folder/slurm.conf" ] || return 0
    scancel --user="$(id -un)" 2>/dev/null && await idle || true
    for daemon in slurmd slurmctld munged; do
        pid=$(cat "$folder/$daemon.pid" 2>/dev/null) || continue
        kill "$pid" 2>/dev/null || continue
        await ended "$pid" || kill -KILL "$pid" 2>/dev/null || true
    done
    # What a damaged cluster left: its processes know its settings.
    for environment in /proc/[0-9]*/environ; do
        pid=${environment//[^0-9]/}
        if grep -q '^slurm' "/proc/$pid/comm" && tr '\0' '\n' <"$environment" | grep -qxF "SLURM_CONF=$SLURM_CONF"; then
            kill -KILL "$pid"
        fi
    done 2>/dev/null
    rm -f "$folder/slurm.conf"
}

case "${1:-} $#" in
"install 1") install ;;
"start 2" | "node 2" | "stop 2")
    folder=$(realpath -m "$2")
    export SLURM_CONF=$folder/slurm.conf
    $1
    ;;
*) fail "usage: cluster.sh install | start FOLDER | node FOLDER | stop FOLDER" ;;
esac
