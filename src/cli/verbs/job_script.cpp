// SPDX-License-Identifier: MIT
#include "verbs/job_script.h"

#include <algorithm>
#include <regex>

#include <fmt/format.h>

namespace oblique::cli {
namespace {

/// A word of a shell, whatever is in it.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') {
      out += "'\\''";
    } else {
      out += c;
    }
  }
  return out + "'";
}

std::string quoted(const std::filesystem::path& path) {
  return quoted(path.string());
}

void check(const char* setting, const std::string& text, const char* pattern, const char* expected) {
  if (text.empty() || std::regex_match(text, std::regex(pattern))) return;
  throw text::ReadError(text::Diagnostic{{{}, {}, text::Setting{setting, text}},
                                         fmt::format("this is no {} that Slurm knows", setting),
                                         expected,
                                         {}});
}

/// A path stands in a line of Slurm's own, which ends with the line.
void check_line(const std::filesystem::path& path) {
  const std::string text = path.string();
  if (text.find_first_of("\n\"%\\") == std::string::npos) return;
  throw text::ReadError(text::Diagnostic{{text, {}},
                                         "Slurm cannot write to a folder of this name",
                                         "a name without quotes, percent signs, backslashes and line ends",
                                         "name another folder"});
}

std::string name_of_job(std::string name) {
  std::replace_if(
      name.begin(), name.end(),
      [](unsigned char c) { return !(std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.'); }, '-');
  return name.empty() ? "oblique" : name;
}

}  // namespace

std::string slurm_script(const JobScript& job) {
  check("time", job.time, R"([0-9]+(:[0-9]{1,2}){0,2}|[0-9]+-[0-9]{1,2}(:[0-9]{1,2}){0,2})",
        R"(minutes, "hours:minutes:seconds" or "days-hours")");
  check("memory", job.memory, "[1-9][0-9]*[KMGT]?",
        R"(a whole number of megabytes, or one with K, M, G or T: "2G")");
  check_line(job.folder);
  std::string blocks;
  for (const std::filesystem::path& folder : job.blocks)
    blocks += fmt::format(" --blocks {}", quoted(folder));
  std::string out = fmt::format(
      "#!/bin/bash\n"
      "# An ensemble in {0} chunks, a job a chunk. Hand it to Slurm: sbatch THIS-FILE. A job that is started "
      "again\n"
      "# begins its chunk anew, and does nothing where the chunk is there. When all have ended:\n"
      "#   {1}{2} ensemble gather {3} -o {4} --table table.csv\n"
      "# says what is missing, or writes the table. Without Slurm: SLURM_ARRAY_TASK_ID=0 bash THIS-FILE, and "
      "so on\n"
      "# to {5}.\n"
      "#SBATCH --job-name={6}\n"
      "#SBATCH --array=0-{5}\n"
      "#SBATCH --ntasks=1\n"
      "#SBATCH --cpus-per-task={7}\n",
      job.chunks, quoted(job.program), blocks, quoted(job.plan), quoted(job.folder), job.chunks - 1,
      name_of_job(job.name), job.threads);
  if (!job.time.empty()) out += fmt::format("#SBATCH --time={}\n", job.time);
  if (!job.memory.empty()) out += fmt::format("#SBATCH --mem={}\n", job.memory);
  out += fmt::format(
      "#SBATCH --requeue\n"
      "#SBATCH --open-mode=append\n"
      "#SBATCH --output=\"{0}/slurm-%A_%a.log\"\n"
      "set -euo pipefail\n"
      ": \"${{SLURM_ARRAY_TASK_ID:?is not set: sbatch sets it, or set it to the number of the chunk, 0 to "
      "{1}}}\"\n"
      "exec {2}{3} ensemble run {4} --chunk \"$SLURM_ARRAY_TASK_ID/{5}\" -o {6} --jobs "
      "\"${{SLURM_CPUS_PER_TASK:-{7}}}\"\n",
      job.folder.string(), job.chunks - 1, quoted(job.program), blocks, quoted(job.plan), job.chunks,
      quoted(job.folder), job.threads);
  return out;
}

}  // namespace oblique::cli
