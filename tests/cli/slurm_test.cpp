// SPDX-License-Identifier: MIT
// The script for Slurm, by Slurm: a cluster of one node, with its own configuration and its own keys.
#include <cstdlib>

#include <gmock/gmock.h>

#include "verbs.h"

namespace oblique::test {
namespace {

constexpr const char* kPlan = R"toml(format = "oblique-ensemble/1"
diagram = "decay.toml"
[vary]
"x.initial" = "1..2:60"
[measure]
last = "end(x)"
)toml";

constexpr const char* kDiagram = R"(format = "oblique-diagram/1"
[blocks]
x = { type = "integrator", in = ["-1*x"], initial = 1 }
)";

/// Some fifteen hundred turns at 1e-10: a chunk of it takes a second or so, time to stop it in the middle.
constexpr const char* kSlowPlan = R"toml(format = "oblique-ensemble/1"
diagram = "swing.toml"
[vary]
"x.initial" = "1..2:600"
[measure]
last = "end(x)"
)toml";

constexpr const char* kSlowDiagram = R"(format = "oblique-diagram/1"
[run]
until = 3000
tolerance = 1e-10
[blocks]
x = { type = "integrator", in = ["v"], initial = 1 }
v = { type = "integrator", in = ["-x"] }
)";

/// Starts munge, slurmctld and slurmd in the folder, does what stands in work.sh, and ends them. Status 77:
/// they do not start here.
constexpr const char* kCluster = R"script(
export PATH=$PATH:/usr/sbin
here=$PWD
pids=()
trap 'kill "${pids[@]}" 2>/dev/null; wait' EXIT
mkdir -m 700 munge; mkdir state spool
head -c 128 /dev/urandom >munge/key; chmod 400 munge/key
munged --force --foreground --key-file="$here/munge/key" --socket="$here/munge/socket" --pid-file="$here/munge/pid" \
  --log-file="$here/munge/log" --seed-file="$here/munge/seed" --num-threads=2 >munged.log 2>&1 &
pids+=($!)
name=$(hostname -s)
ports=$((20000 + RANDOM % 10000))
cat >slurm.conf <<CONF
ClusterName=test
SlurmctldHost=$name(127.0.0.1)
SlurmctldPort=$ports
SlurmdPort=$((ports + 1))
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
AuthInfo=socket=$here/munge/socket
CredType=cred/munge
StateSaveLocation=$here/state
SlurmdSpoolDir=$here/spool
SlurmctldPidFile=$here/slurmctld.pid
SlurmdPidFile=$here/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
KillWait=2
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=1,batch_sched_delay=0
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
ReturnToService=2
SlurmdParameters=config_overrides
NodeName=$name NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=$name Default=YES State=UP
CONF
export SLURM_CONF=$here/slurm.conf
for k in {1..50}; do [[ -S munge/socket ]] && break; sleep 0.1; done
slurmctld -D -i >slurmctld.log 2>&1 &
pids+=($!)
slurmd -D -N "$name" >slurmd.log 2>&1 &
pids+=($!)
for k in {1..100}; do sinfo --noheader --format=%T 2>/dev/null | grep -q idle && break; sleep 0.1; done
sinfo --noheader --format=%T 2>/dev/null | grep -q idle || { cat ./*.log >&2; exit 77; }
# ended: until all jobs have ended
ended() {
  for k in {1..300}; do [[ -z $(squeue --noheader) ]] && return; sleep 0.1; done
  squeue; return 1
}
# run FILE [OPTION…]: until all its jobs have ended
run() {
  sbatch "${@:2}" "$1" && ended
}
# stop CHUNK: stops the process that makes it, whose number is then in $maker
stop() {
  for k in {1..500}; do
    for maker in $(scontrol listpids 2>/dev/null | awk '$1 > 0 { print $1 }'); do
      tr '\0' ' ' 2>/dev/null <"/proc/$maker/cmdline" | grep -q "^[^ ]*oblique ensemble run .* --chunk $1/" || continue
      kill -STOP "$maker" && return
    done
    sleep 0.02
  done
  echo "no process makes chunk $1"; return 1
}
set -e
oblique ensemble script plan.toml --slurm --chunks 5 --time 5 -o job.sh
run job.sh
oblique ensemble gather plan.toml -o plan.chunks --table all.csv
rm plan.chunks/3-of-5-*
oblique ensemble gather plan.toml -o plan.chunks --table missing.csv && exit 1
run job.sh --array=2,3
oblique ensemble gather plan.toml -o plan.chunks --table again.csv
cat plan.chunks/*.log
# One that is requeued in the middle of its chunk, and one whose process is killed there.
oblique ensemble script slow.toml --slurm --chunks 3 --time 5 -o slow.sh
job=$(sbatch --parsable --array=0-2%1 slow.sh)
stop 0
[[ ! -e $(echo slow.chunks/0-of-3-*) ]]
scontrol requeue "${job}_0"
stop 1
kill -KILL "$maker"
# Slurm waits two minutes before a job that was requeued begins again: here it need not.
for k in {1..100}; do squeue --noheader --array --format='%K %r' | grep -q '^0 BeginTime' && break; sleep 0.1; done
scontrol update "jobid=${job}_0" starttime=now
ended
scontrol show job "${job}_0" | grep -o 'Restarts=1'
cat slow.chunks/*_0.log
oblique ensemble gather slow.toml -o slow.chunks --table missing.csv 2>&1 && exit 1
run slow.sh --array=1
oblique ensemble gather slow.toml -o slow.chunks --table slow.csv
)script";

class Slurm : public Verbs {};

TEST_F(Slurm, RunsTheScript) {
  for (const char* program : {"munged", "slurmctld", "slurmd", "sbatch"}) {
    if (std::system(
            ("PATH=$PATH:/usr/sbin command -v " + std::string(program) + " >/dev/null 2>&1").c_str()) != 0)
      GTEST_SKIP() << program << " is not installed (Debian: slurmctld slurmd slurm-client munge)";
  }
  std::ofstream(file("plan.toml")) << kPlan;
  std::ofstream(file("decay.toml")) << kDiagram;
  std::ofstream(file("slow.toml")) << kSlowPlan;
  std::ofstream(file("swing.toml")) << kSlowDiagram;
  std::ofstream(file("cluster.sh")) << kCluster;
  const Outcome outcome = run_command("bash cluster.sh", file(""));
  if (outcome.status == 77) GTEST_SKIP() << "Slurm does not start here:\n" << outcome.err;
  ASSERT_EQ(outcome.status, 0) << outcome.out << outcome.err;
  run_command("oblique ensemble run plan.toml -o serial --table serial.csv", file(""));
  EXPECT_FALSE(bytes_of("serial.csv").empty());
  EXPECT_EQ(bytes_of("all.csv"), bytes_of("serial.csv"));
  EXPECT_EQ(bytes_of("again.csv"), bytes_of("serial.csv"));
  EXPECT_FALSE(std::filesystem::exists(file("missing.csv")));
  // The chunk that was there was not made again.
  EXPECT_THAT(outcome.out, ::testing::HasSubstr("0 chunks made in "));

  EXPECT_THAT(outcome.out,
              ::testing::AllOf(::testing::HasSubstr("Restarts=1"), ::testing::HasSubstr("DUE TO JOB REQUEUE"),
                               ::testing::HasSubstr("1 of 3 chunks is missing: 1/3\n")));
  run_command("oblique ensemble run slow.toml -o serial-slow --table serial-slow.csv", file(""));
  EXPECT_FALSE(bytes_of("serial-slow.csv").empty());
  EXPECT_EQ(bytes_of("slow.csv"), bytes_of("serial-slow.csv"));
}

}  // namespace
}  // namespace oblique::test
