// SPDX-License-Identifier: MIT
// Plans of ensembles by the program: chunks, the table of all, scripts for clusters, and what is refused.
#include <chrono>
#include <csignal>
#include <thread>

#include <gmock/gmock.h>

#include <sys/wait.h>
#include <unistd.h>

#include "verbs.h"

namespace oblique::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class EnsembleVerb : public Verbs {
 protected:
  /// A decay, whose values at the end are known: x(1) = h exp(−r).
  EnsembleVerb() {
    write("decay.toml", R"(format = "oblique-diagram/1"
[run]
until = 1
[blocks]
x = { type = "integrator", in = ["-1*x"], initial = 1 }
[outputs]
x = "x"
)");
    write("plan.toml", plan("1..2:40"));
  }

  static std::string plan(const std::string& heights, const std::string& more = "") {
    return "format = \"oblique-ensemble/1\"\n" + more +
           "diagram = \"decay.toml\"\n[vary]\n\"x.initial\" = \"" + heights +
           "\"\n\"x.in[1]\" = [-1, -2]\n[measure]\nlast = \"end(x)\"\n";
  }
  void write(const std::string& name, const std::string& text) const { std::ofstream(file(name)) << text; }
  /// In the folder of the plan.
  Outcome in_folder(const std::string& command) const {
    Outcome outcome = run_command(command, file(""));
    return outcome;
  }
  std::size_t files_in(const std::string& name) const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(file(name)), {}));
  }
};

TEST_F(EnsembleVerb, RunsAndWritesTheTable) {
  const Outcome outcome = in_folder("oblique ensemble run plan.toml -o all --table all.csv");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("1 chunk made in all, 0 there already\nwrote all.csv\n80 machines: ")));
  std::string header;
  const auto rows = csv_rows(file("all.csv"), header);
  EXPECT_EQ(header, "x.initial,x.in[1],last");
  ASSERT_EQ(rows.size(), 80U);
  for (const std::vector<double>& row : rows) {
    // The solver's tolerance, 1e-8, and what docs/running.md says of the errors that add up.
    EXPECT_NEAR(row[2], row[0] * std::exp(row[1]), 1e-7);
  }
}

// The promise of the page: whoever runs which chunk, in whatever order, with as many threads.
TEST_F(EnsembleVerb, GivesTheSameBytesHoweverItIsCut) {
  in_folder("oblique ensemble run plan.toml -o all --jobs 1 --table all.npy");
  in_folder("for i in 3 1 7 5 2 6 4; do oblique ensemble run plan.toml --chunk $i/7 -o seven --jobs 2; done");
  in_folder("for i in 0 1 2; do oblique ensemble run plan.toml --chunk $i/3 -o three; done");
  in_folder("oblique ensemble run plan.toml --chunks 80 -o many");
  EXPECT_EQ(files_in("seven"), 7U);
  EXPECT_EQ(files_in("many"), 80U);
  for (const std::string folder : {"seven", "three", "many"}) {
    const Outcome gathered =
        in_folder("oblique ensemble gather plan.toml -o " + folder + " --table " + folder + ".npy");
    EXPECT_EQ(gathered.status, 0) << gathered.err;
    EXPECT_FALSE(bytes_of("all.npy").empty());
    EXPECT_TRUE(bytes_of(folder + ".npy") == bytes_of("all.npy")) << folder;
  }
}

TEST_F(EnsembleVerb, GoesOnWithWhatIsMissing) {
  in_folder(
      "oblique ensemble run plan.toml --chunk 1/4 -o c; oblique ensemble run plan.toml --chunk 2/4 -o c");
  const Outcome missing = in_folder("oblique ensemble gather plan.toml -o c --table t.csv");
  EXPECT_EQ(missing.status, 1);
  EXPECT_EQ(missing.err,
            "error: c: 2 of 4 chunks are missing: 0/4 (that is 4/4), 3/4\n"
            "  remedy: `oblique ensemble run plan.toml --chunks 4 -o c` makes what is missing\n");
  EXPECT_FALSE(std::filesystem::exists(file("t.csv")));
  const Outcome status = in_folder("oblique ensemble status plan.toml -o c");
  EXPECT_EQ(status.status, 1);
  EXPECT_EQ(status.out,
            "40 of 80 runs are there, in 2 chunks\nmissing: 0/4 (that is 4/4) (machines 0 to 19)\n"
            "missing: 3/4 (machines 60 to 79)\n");
  EXPECT_THAT(in_folder("oblique ensemble run plan.toml --chunks 4 -o c").err,
              HasSubstr("2 chunks made in c, 2 there already\n"));
  EXPECT_THAT(in_folder("oblique ensemble run plan.toml --chunk 3/4 -o c").err,
              HasSubstr("0 chunks made in c, 1 there already\n"));
  EXPECT_EQ(in_folder("oblique ensemble status plan.toml -o c").status, 0);
  EXPECT_EQ(in_folder("oblique ensemble gather plan.toml -o c --table t.csv").status, 0);
}

TEST_F(EnsembleVerb, TellsOfDamagedChunksAndReplacesThem) {
  in_folder("oblique ensemble run plan.toml --chunks 2 -o c --table good.csv");
  in_folder("for f in c/1-of-2-*; do head -c 900 $f >half; cp half $f; done");
  const Outcome gathered = in_folder("oblique ensemble gather plan.toml -o c --table t.csv");
  EXPECT_EQ(gathered.status, 1);
  EXPECT_THAT(
      gathered.err,
      AllOf(HasSubstr("error: c/1-of-2-"),
            HasSubstr(
                ".chunk: this chunk counts as missing: it is not whole, or was changed: its bytes are not "
                "those that were written\n  remedy: run it again, which replaces it\n"),
            HasSubstr("error: c: 1 of 2 chunks is missing: 1/2\n")));
  EXPECT_THAT(in_folder("oblique ensemble run plan.toml --chunks 2 -o c --table t.csv").err,
              HasSubstr("1 chunk made in c, 1 there already\n"));
  EXPECT_EQ(bytes_of("t.csv"), bytes_of("good.csv"));
}

TEST_F(EnsembleVerb, RefusesChunksOfSomethingElse) {
  in_folder("oblique ensemble run plan.toml --chunk 0/2 -o c");
  write("plan.toml", plan("1..3:40"));
  Outcome gathered = in_folder("oblique ensemble gather plan.toml -o c --table t.csv");
  EXPECT_EQ(gathered.status, 2);
  EXPECT_THAT(gathered.err,
              HasSubstr(".chunk: this chunk is of another plan; expected chunks with just the settings and "
                        "the seed of the plan\n  remedy: move this chunk to another folder"));
  write("plan.toml", plan("1..2:40"));
  EXPECT_THAT(in_folder("oblique ensemble gather plan.toml -o c --table t.csv").err,
              HasSubstr("missing: 1/2"));
  in_folder("echo '# changed' >>decay.toml");
  gathered = in_folder("oblique ensemble gather plan.toml -o c --table t.csv");
  EXPECT_EQ(gathered.status, 2);
  EXPECT_THAT(gathered.err,
              HasSubstr("this chunk is of another diagram or mechanism, or of an earlier state of it"));
  // Where the table is asked for that is known before the work.
  EXPECT_EQ(in_folder("oblique ensemble run plan.toml -o c --table t.csv").status, 2);
  EXPECT_EQ(files_in("c"), 1U);
}

TEST_F(EnsembleVerb, LeavesOutWhatIsNoChunkOfThePlan) {
  in_folder(
      "oblique ensemble run plan.toml --chunk 0/2 -o c; : >c/notes.chunk; for k in $(seq 20); do : "
      ">c/1-of-2-$k.chunk; done");
  const Outcome gathered = in_folder("oblique ensemble gather plan.toml -o c --table t.csv");
  EXPECT_EQ(gathered.status, 1);
  EXPECT_THAT(gathered.err,
              AllOf(HasSubstr("1.chunk: this is no chunk of the plan, and is left out: the file is empty\n  "
                              "remedy: delete it\n"),
                    HasSubstr("error: c: 11 more are damaged (`oblique ensemble status` lists them)\n"),
                    HasSubstr("error: c: 1 of 2 chunks is missing: 1/2\n")));
  EXPECT_THAT(in_folder("oblique ensemble status plan.toml -o c").out,
              HasSubstr("no chunk of the plan: c/notes.chunk: the file is empty\n"));
  EXPECT_EQ(in_folder("oblique ensemble run plan.toml --chunks 2 -o c --table t.csv").status, 0);
}

TEST_F(EnsembleVerb, SaysHowFarItCameBeforeAChunkCouldNotBeWritten) {
  in_folder("oblique ensemble run plan.toml --chunk 1/2 -o d; mkdir c; mkdir c/$(ls d)");
  const Outcome outcome = in_folder("oblique ensemble run plan.toml --chunks 2 -o c");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(
      outcome.err,
      AllOf(HasSubstr("1 chunk was made in c before that; the same command goes on with what is missing\n"),
            HasSubstr("cannot write the file: Is a directory")));
  EXPECT_EQ(in_folder("rmdir c/1-of-2*; oblique ensemble run plan.toml --chunks 2 -o c --table t.csv").status,
            0);
}

TEST_F(EnsembleVerb, WarnsOfAPlanOfAnotherVersion) {
  write("plan.toml", plan("1..2:2", "version = \"0.0.7\"\n"));
  const Outcome outcome = in_folder("oblique ensemble run plan.toml -o c");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(
      outcome.err,
      HasSubstr("warning: plan.toml: the plan was written by version 0.0.7 of the program, this is "));
}

struct Refusal {
  const char* command;
  int status;
  const char* says;
};

TEST_F(EnsembleVerb, RefusesWhatMakesNoSense) {
  write("bad.toml",
        "format = \"oblique-ensemble/1\"\ndiagram = \"decay.toml\"\nrun = 3\n[vary]\n\"x.initail\" = 1\n"
        "[measure]\na = \"end(x)\"\n");
  write("name.toml",
        "format = \"oblique-ensemble/1\"\ndiagram = \"decay.toml\"\n[vary]\n\"x.initail\" = 1\n"
        "[measure]\na = \"end(x)\"\n");
  write("lost.toml",
        "format = \"oblique-ensemble/1\"\ndiagram = \"nowhere.toml\"\n[vary]\n\"x.initial\" = 1\n"
        "[measure]\na = \"end(x)\"\n");
  write("taken", "");
  for (const Refusal& refusal : std::vector<Refusal>{
           {"ensemble run plan.toml --chunk 5/4 -o c", 2,
            "error: --chunk: there is no chunk 5 of 4; expected a number from 0 to 3, or from 1 to 4\n"},
           {"ensemble run plan.toml --chunk 1/81 -o c", 2,
            "error: --chunk: an ensemble of 80 runs is not cut into 81 chunks; expected from 1 to 80 "
            "chunks\n"},
           {"ensemble run plan.toml --chunk half -o c", 2,
            "error: --chunk: 'half' is no part of an ensemble; expected i/n, the i-th of n chunks, such as "
            "3/16\n"},
           {"ensemble run plan.toml --chunk 1/2 --chunks 2 -o c", 2,
            "error: --chunk makes one chunk and --chunks all; expected one of the two\n"},
           {"ensemble run plan.toml --chunk 1/2 --table t.csv -o c", 2, "error: --table is for all chunks"},
           {"ensemble run plan.toml -o taken", 2, "taken: no folder can be made here: "},
           {"ensemble run plan.toml", 2, "--output is required\n  remedy: oblique ensemble run --help"},
           {"ensemble gather plan.toml -o nowhere --table t.csv", 2,
            "error: nowhere: cannot read the chunks here: No such file or directory"},
           {"ensemble gather plan.toml -o . --table t.csv", 1,
            "error: .: there is no chunk of plan.toml here\n  remedy: `oblique ensemble run plan.toml -o .` "
            "makes them\n"},
           {"ensemble gather plan.toml -o . --table t.txt", 2, "t.txt: "},
           {"ensemble run decay.toml -o c", 2,
            "error: decay.toml:1:10: the format is 'oblique-diagram/1'; expected 'oblique-ensemble/1'\n  "
            "remedy: this is a "
            "diagram: `oblique run`, "},
           {"run plan.toml", 2, "remedy: this is a plan of an ensemble: `oblique ensemble run` takes it"},
           {"ensemble run bad.toml -o c", 2,
            "error: bad.toml:3:1: unknown key 'run' in the plan\n  remedy: did you mean 'runs'?"},
           {"ensemble run name.toml -o c", 2, "name.toml:4:"},
           {"ensemble run lost.toml -o c", 2, "nowhere.toml: cannot open the file"},
           {"ensemble script plan.toml", 2,
            "error: nothing says which kind of script is wanted; expected --slurm\n"},
           {"ensemble script plan.toml --slurm --time soon", 2,
            "error: --time soon: this is no time that Slurm knows; expected minutes, "
            "\"hours:minutes:seconds\""},
           {"ensemble script plan.toml --slurm --memory 2GB", 2,
            "error: --memory 2GB: this is no memory that Slurm knows"},
           {"ensemble script plan.toml --slurm -o job.txt", 2, "job.txt"},
           {"ensemble", 2, "remedy: oblique ensemble --help lists the commands"},
           {"ensemble rnu plan.toml", 2, "error: there is no command 'rnu'\n  remedy: did you mean 'run'?\n"},
           {"ensemble gather plan.toml --tabel t.csv", 2,
            "error: 'ensemble gather' has no option '--tabel'\n  remedy: did you mean '--table'?\n"}}) {
    const Outcome outcome = in_folder("oblique " + std::string(refusal.command));
    EXPECT_EQ(outcome.status, refusal.status) << refusal.command << "\n" << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(refusal.says)) << refusal.command;
  }
}

// What a sweep writes as a plan is that sweep.
TEST_F(EnsembleVerb, IsTheSweepThatWroteThePlan) {
  for (const std::string options :
       {"--vary 'x.initial=1..2:20' --vary 'x.in[1]=-1,-2' --measure 'last = end(x)' --samples 101",
        "--vary 'x.initial=1..2:20' --latin --runs 30 --seed 18446744073709551615 --tolerance 1e-9",
        "--scatter integrator.initial=0.1 --runs 50 --measure 'max(x)'",
        "--tolerance-of-elements 1% --runs 20 --seed 3"}) {
    SCOPED_TRACE(options);
    const Outcome written =
        in_folder("mkdir -p plans; oblique sweep decay.toml " + options + " --plan plans/p.toml");
    EXPECT_EQ(written.status, 0) << written.err;
    EXPECT_EQ(written.err, "wrote plans/p.toml\n");
    EXPECT_THAT(bytes_of("plans/p.toml"),
                AllOf(HasSubstr("diagram = \"../decay.toml\"\n"), HasSubstr("version = \"")));
    const Outcome swept = in_folder("oblique sweep decay.toml " + options + " -o swept.npy");
    EXPECT_EQ(swept.status, 0) << swept.err;
    const Outcome ran =
        in_folder("rm -rf c; oblique ensemble run plans/p.toml --chunks 3 -o c --jobs 2 --table ran.npy");
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_THAT(ran.err, Not(HasSubstr("warning")));
    EXPECT_FALSE(bytes_of("swept.npy").empty());
    EXPECT_TRUE(bytes_of("ran.npy") == bytes_of("swept.npy"));
  }
}

TEST_F(EnsembleVerb, TellsOfAFullDisk) {
  // A limit of the shell in place of a disk: a block of 512 bytes, and no signal.
  const Outcome outcome =
      in_folder("mkdir c; trap '' XFSZ; ulimit -f 1; oblique ensemble run plan.toml -o c");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("cannot write the file: File too large"));
  EXPECT_EQ(files_in("c"), 0U);
}

#ifdef OBLIQUE_FAULTS
// Each read and write fails in turn, once (tests/support/faults.cpp): what is there then is whole, and going
// on gives what it gives without a fault.
TEST_F(EnsembleVerb, LosesNothingWhereAReadOrWriteFails) {
  write("plan.toml", plan("1..2:3"));
  const std::string command = "oblique ensemble run plan.toml --chunks 2 --jobs 1 -o c --table t.csv";
  in_folder(command + " && mv t.csv good.csv");
  bool reached_the_end = false;
  int told = 0;
  for (int call = 1; call < 200 && !reached_the_end; ++call) {
    SCOPED_TRACE("file:" + std::to_string(call));
    const Outcome outcome =
        in_folder("rm -rf c t.csv; LD_PRELOAD=" OBLIQUE_FAULTS " OBLIQUE_FAULT=file:" + std::to_string(call) +
                  " OBLIQUE_FAULT_COUNTS=counts " + command);
    if (outcome.status != 0) {
      ++told;
      EXPECT_EQ(outcome.status, 2);
      EXPECT_THAT(outcome.err, HasSubstr("error: "));
      // Whole or not there: also where only what is said on stdout was lost.
      if (std::filesystem::exists(file("t.csv"))) {
        EXPECT_EQ(bytes_of("t.csv"), bytes_of("good.csv"));
      }
    }
    const Outcome status =
        in_folder("mkdir -p c; oblique ensemble status plan.toml -o c; ls -A c | grep -v 'chunk$'");
    EXPECT_THAT(status.out + status.err, AllOf(Not(HasSubstr("damaged")), Not(HasSubstr("part"))));
    EXPECT_EQ(in_folder(command).status, 0);
    EXPECT_EQ(bytes_of("t.csv"), bytes_of("good.csv"));
    long memory_calls = 0, file_calls = 0;
    std::ifstream(file("counts")) >> memory_calls >> file_calls;
    reached_the_end = file_calls < call;
  }
  EXPECT_TRUE(reached_the_end);
  EXPECT_GT(told, 8);  // plan, subject, two chunks and the table are read and written
}
#endif

TEST_F(EnsembleVerb, ScriptRunsWithoutSlurm) {
  const Outcome written = in_folder(
      "oblique ensemble script plan.toml --slurm --chunks 3 --jobs 2 --time 2:00:00 "
      "--memory 2G --folder \"it's here\" -o job.sh");
  EXPECT_EQ(written.status, 0) << written.err;
  const std::string script = bytes_of("job.sh");
  for (const char* line : {"#SBATCH --array=0-2\n", "#SBATCH --cpus-per-task=2\n", "#SBATCH --time=2:00:00\n",
                           "#SBATCH --mem=2G\n", "#SBATCH --requeue\n"})
    EXPECT_THAT(script, HasSubstr(line));
  const Outcome without = in_folder("bash job.sh");
  EXPECT_NE(without.status, 0);
  EXPECT_THAT(
      without.err,
      HasSubstr("SLURM_ARRAY_TASK_ID: is not set: sbatch sets it, or set it to the number of the chunk"));
  // From anywhere, in any order, one of them twice.
  for (const char* task : {"2", "0", "2", "1"}) {
    const Outcome ran =
        run_command("SLURM_ARRAY_TASK_ID=" + std::string(task) + " bash '" + file("job.sh") + "'", "/");
    EXPECT_EQ(ran.status, 0) << ran.err;
  }
  EXPECT_EQ(in_folder("oblique ensemble gather plan.toml -o \"it's here\" --table t.csv").status, 0);
  in_folder("oblique ensemble run plan.toml -o all --table all.csv");
  EXPECT_EQ(bytes_of("t.csv"), bytes_of("all.csv"));
}

/// A plan that would run for hours, in chunks of a second.
class LongEnsemble : public EnsembleVerb {
 protected:
  LongEnsemble() { write("plan.toml", plan("1..2:500000")); }

  pid_t start() const {
    const pid_t child = fork();
    if (child != 0) return child;
    setpgid(0, 0);
    std::signal(SIGINT, SIG_DFL);
    if (chdir(file("").c_str()) == 0 && freopen("err", "w", stderr) != nullptr)
      execl(OBLIQUE_PROGRAM, "oblique", "ensemble", "run", "plan.toml", "--chunks", "10000", "-o", "c",
            nullptr);
    _exit(127);
  }
  /// Waits until there are some chunks.
  bool has_begun() const {
    for (int k = 0; k < 3000; ++k) {
      if (std::filesystem::exists(file("c")) && files_in("c") > 2) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }
};

TEST_F(LongEnsemble, KeepsWhatIsDoneAtCtrlC) {
  const pid_t child = start();
  ASSERT_TRUE(has_begun());
  kill(child, SIGINT);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGINT) << status;
  EXPECT_THAT(bytes_of("err"), HasSubstr("interrupted: the same command goes on with what is missing\n"));
  // Nothing is half there.
  EXPECT_THAT(in_folder("oblique ensemble status plan.toml -o c").out, Not(HasSubstr("damaged")));
}

TEST_F(LongEnsemble, IsNeverHalfThereAfterAKill) {
  const pid_t child = start();
  ASSERT_TRUE(has_begun());
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  for (const auto& entry : std::filesystem::directory_iterator(file("c")))
    EXPECT_EQ(entry.path().extension(), ".chunk") << entry.path();
  const Outcome status = in_folder("oblique ensemble status plan.toml -o c");
  EXPECT_EQ(status.status, 1);
  EXPECT_THAT(status.out, Not(HasSubstr("damaged")));
}

/// Whether a program is installed.
bool is_there(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

// As docs/ensembles.md has it: a job that failed is run again, the others are not.
TEST_F(EnsembleVerb, IsResumedByParallel) {
  if (!is_there("parallel")) GTEST_SKIP() << "GNU parallel is not installed (Debian: parallel)";
  const std::string command =
      "HOME=$PWD parallel --will-cite --jobs 2 --joblog jobs.log --resume-failed 'oblique ensemble run "
      "plan.toml "
      "--chunk {}/5 -o c' ::: 1 2 3 4 5";
  in_folder("mv decay.toml away.toml");
  EXPECT_EQ(in_folder(command).status, 5);  // so many failed
  in_folder("mv away.toml decay.toml; oblique ensemble run plan.toml --chunk 3/5 -o c");
  const Outcome again = in_folder(command);
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("0 chunks made in c, 1 there already"));  // the third
  const Outcome nothing = in_folder(command);
  EXPECT_EQ(nothing.status, 0) << nothing.err;
  EXPECT_THAT(nothing.err, Not(HasSubstr("made in c")));
  EXPECT_EQ(in_folder("oblique ensemble gather plan.toml -o c --table t.csv").status, 0);
  in_folder("oblique ensemble run plan.toml -o all --table all.csv");
  EXPECT_EQ(bytes_of("t.csv"), bytes_of("all.csv"));
}

}  // namespace
}  // namespace oblique::test
