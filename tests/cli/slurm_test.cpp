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
# run FILE [OPTION…]: until all its jobs have ended
run() {
  sbatch "${@:2}" "$1" || return
  for k in {1..300}; do [[ -z $(squeue --noheader) ]] && return; sleep 0.1; done
  squeue; return 1
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
  EXPECT_THAT(outcome.out, testing::HasSubstr("0 chunks made in "));
}

}  // namespace
}  // namespace oblique::test
