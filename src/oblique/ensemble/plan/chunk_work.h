// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include <oblique/ensemble/plan/chunk_file.h>
#include <oblique/ensemble/study/study.h>

namespace oblique::ensemble {

/// An ensemble that is worked off chunk by chunk: what it is, and who runs it.
struct ChunkWork {
  Identity identity;
  std::uint64_t runs = 0;
  std::vector<text::TableColumn> columns;
  std::function<Study::Rows(std::uint64_t first, std::uint64_t count, const Ensemble::Progress& progress)>
      run;
};

/// The study must outlive it.
ChunkWork work_of(const Study& study, Identity identity);

/// Runs the machines of a chunk.
Chunk run_chunk(const ChunkWork& work, const ChunkPlace& place, const Ensemble::Progress& progress = {});

/// Whether a file is just this chunk, whole and unharmed.
bool is_done(const std::filesystem::path& file, const ChunkWork& work, const ChunkPlace& place);

/// Makes the file of a chunk in a folder (which is made where it is not there), unless it is there already
/// (then false). The file takes its name when all of it is on the disk: whatever ends the work before leaves
/// nothing of that name, or the old file, which is then replaced by the next attempt. Two that make the same
/// chunk at once write the same bytes. Throws ReadError where the file cannot be written.
bool make_chunk(const std::filesystem::path& folder, const ChunkWork& work, const ChunkPlace& place,
                const Ensemble::Progress& progress = {});

/// Makes the folder of chunks, if it is not there. Throws ReadError.
void make_folder(const std::filesystem::path& folder);

/// Into how many chunks an ensemble is cut where nothing is said: of about 1000 runs, and not more than the
/// longest array of jobs that Slurm takes by itself.
std::uint64_t usual_chunks(std::uint64_t runs);

}  // namespace oblique::ensemble
