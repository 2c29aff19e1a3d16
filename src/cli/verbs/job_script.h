// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <oblique/text/diagnostic.h>

namespace oblique::cli {

/// The longest array of jobs that Slurm takes unless it is told otherwise (MaxArraySize 1001, which is the
/// first number that it does not take).
inline constexpr std::uint64_t kLongestArray = 1001;

/// What a job of a cluster is to do, and what it may take.
struct JobScript {
  std::filesystem::path program;  ///< oblique, where the jobs find it
  std::vector<std::filesystem::path> blocks;
  std::filesystem::path plan, folder;  ///< of the chunks
  std::string name;                    ///< of the job
  std::uint64_t chunks = 1;
  int threads = 1;     ///< of each job
  std::string time;    ///< the most of each job, as Slurm writes it ("2:00:00"); empty: as the cluster has it
  std::string memory;  ///< of each job ("2G"); empty: as the cluster has it
};

/// A script for an array of jobs of Slurm, one a chunk. A job that is started again, or twice, does no harm.
/// Without Slurm, bash runs it with SLURM_ARRAY_TASK_ID set. Throws ReadError where `time` or `memory` is
/// nothing that Slurm knows.
std::string slurm_script(const JobScript& job);

}  // namespace oblique::cli
