#!/usr/bin/env bash
# slurm.sh CASE VTS JSON_CHECK: an array of jobs in a Slurm of our own, on this machine alone; see harness.sh. Skipped (77) where it is not
# installed, or where we may not start its daemons.
source "${BASH_SOURCE%/*}/harness.sh"

skip() { echo "skipped: $*"; exit 77; }
for program in slurmctld slurmd sbatch squeue scancel scontrol; do
  PATH=$PATH:/usr/sbin command -v $program >where || skip "no $program here (Debian: slurm-wlm)"
done
rm where
[ "$(id -u)" = 0 ] || skip "Slurm's daemons want to be root"
PATH=$PATH:/usr/sbin
daemons=()
stop() { [ ${#daemons[@]} = 0 ] || { kill "${daemons[@]}"; sleep 0.3; kill -s KILL "${daemons[@]}"; } 2>/dev/null; chmod -R u+w "$folder"; rm -rf "$folder"; }
trap stop EXIT
trap 'exit 1' INT TERM

# Two ports that nobody listens at.
free_port() {
  local port
  for port in $(shuf -i 20000-60000 -n 50); do (: <>"/dev/tcp/127.0.0.1/$port") 2>/dev/null || { echo "$port"; return; }; done
}

start_slurm() {
  local controller node host cpus
  controller=$(free_port) node=$(free_port) host=$(hostname -s) cpus=$(nproc)
  mkdir -m 755 s s/state s/spool
  chmod 755 "$folder"
  cat >s/slurm.conf <<S
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$controller
SlurmdPort=$node
SlurmUser=root
AuthType=auth/none
CredType=cred/none
StateSaveLocation=$PWD/s/state
SlurmdSpoolDir=$PWD/s/spool
SlurmctldPidFile=$PWD/s/ctld.pid
SlurmdPidFile=$PWD/s/slurmd.pid
SlurmctldLogFile=$PWD/s/ctld.log
SlurmdLogFile=$PWD/s/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
SchedulerType=sched/builtin
SchedulerParameters=batch_sched_delay=0,sched_min_interval=0,sched_interval=1
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
KillWait=1
MinJobAge=300
NodeName=$host NodeAddr=127.0.0.1 CPUs=$cpus State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
S
  export SLURM_CONF=$PWD/s/slurm.conf
  local tries
  slurmctld -D >s/ctld.out 2>&1 & daemons+=($!)
  slurmd -D -N "$host" >s/slurmd.out 2>&1 & daemons+=($!)
  for ((tries = 0; tries < 100; tries++)); do
    scontrol show node "$host" 2>/dev/null | grep -q 'State=IDLE' && return
    sleep 0.1
  done
  tail -n 5 s/*.log s/*.out >&2
  skip "Slurm does not start here"
}

# Until a job, with all of its tasks, is no longer in the queue.
wait_for() {
  local tries
  for ((tries = 0; tries < 900; tries++)); do
    [ -z "$(squeue -h -j "$1" 2>/dev/null)" ] && return
    sleep 0.1
  done
  fail "job $1 is still there: $(squeue -j "$1")"
}

case_array() {
  cat >film.vts <<'S'
animation { frames 3 fps 2 }
camera { location <0, 1.5, -4> look_at <0, 0.5, 0> }
light_source { <5, 10, -5> rgb 1 }
sphere { <clock, 0.5, 0>, 0.5 pigment { rgb <0.8, 0.2, 0.1> } }
S
  run film.vts -s 40x30 -o w.ppm
  start_slurm
  run farm slurm film.vts -s 40x30 -o a.ppm --regions 1x2 --at-once 2; want_status 0
  want_in out 'film.slurm: 6 of 6 jobs'
  local array stitch n
  array=$(sed -n 's/submitted as job //p' out) stitch=$(sed -n 's/its parts will be joined by job //p' out)
  [ -n "$array" ] && [ -n "$stitch" ] || fail "what was submitted: $(cat out err)"
  wait_for "$array"; wait_for "$stitch"
  for n in 1 2 3; do cmp -s w$n.ppm a$n.ppm || fail "frame $n: $(cat slurm-*.out)"; done

  # A task is killed in the middle: what depends on it does not run, and the next array has that task alone. Both tasks of
  # frame 2 go in circles until the file is there that says that one of them was killed, however fast or slow the machine.
  rm -f a?.ppm a?.r*.ppm
  cp film.vts slow.vts
  cat >>slow.vts <<'S'
#if (frame_number = 2) #declare I = 0; #while (I < 1e8 & !file_exists("killed")) #declare I = I + 1; #end #end
S
  run farm slurm slow.vts -s 40x30 -o a.ppm --regions 1x2 --at-once 2
  array=$(sed -n 's/submitted as job //p' out) stitch=$(sed -n 's/its parts will be joined by job //p' out)
  for ((n = 0; n < 200; n++)); do squeue -h -t R -j "${array}_2" 2>/dev/null | grep -q . && break; sleep 0.1; done
  scancel "${array}_2"
  wait_for "${array}_2"; touch killed
  wait_for "$array"; wait_for "$stitch"
  [ ! -e a2.r0c0.ppm ] || fail "the killed task has made its picture"
  [ -s a2.r1c0.ppm ] && [ -s a3.r1c0.ppm ] || fail "the other tasks have not: $(ls)"
  [ ! -e a1.ppm ] || fail "joined, though a task was killed"
  run farm slurm slow.vts -s 40x30 -o a.ppm --regions 1x2 --resume; want_in out '1 of 6 jobs'
  grep -qxF '#SBATCH --array=2' slow.slurm || fail "array: $(grep array slow.slurm)"
  array=$(sed -n 's/submitted as job //p' out) stitch=$(sed -n 's/its parts will be joined by job //p' out)
  wait_for "$array"; wait_for "$stitch"
  for n in 1 2 3; do cmp -s w$n.ppm a$n.ppm || fail "frame $n after a killed task: $(cat slurm-*.out)"; done
}

run_case
