// SPDX-License-Identifier: MIT
#include <oblique/ensemble/plan/chunk_work.h>

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include <fmt/format.h>

#include <oblique/text/file.h>
#include <oblique/text/new_file.h>

namespace oblique::ensemble {

ChunkWork work_of(const Study& study, Identity identity) {
  return {std::move(identity), study.runs(), study.columns(),
          [&study](std::uint64_t first, std::uint64_t count, const Ensemble::Progress& progress) {
            return study.run(first, count, progress);
          }};
}

Chunk run_chunk(const ChunkWork& work, const ChunkPlace& place, const Ensemble::Progress& progress) {
  Study::Rows found = work.run(place.first, place.count, progress);
  Chunk chunk{{work.identity, place, {}, std::move(found.count), {}}, {}};
  for (const text::TableColumn& column : work.columns) chunk.head.columns.push_back(column.name);
  chunk.rows.reserve(found.rows.size() * work.columns.size());
  for (StudyRow& row : found.rows) {
    chunk.rows.insert(chunk.rows.end(), row.values.begin(), row.values.end());
    if (!row.failure.empty()) chunk.head.failures.emplace_back(row.number, std::move(row.failure));
  }
  return chunk;
}

bool is_done(const std::filesystem::path& file, const ChunkWork& work, const ChunkPlace& place) {
  std::error_code none;
  if (!std::filesystem::exists(file, none)) return false;
  ReadChunk read;
  try {
    read = parse_chunk(text::read_file(file));
  } catch (const text::ReadError&) {  // somebody else has deleted it meanwhile, or it cannot be read
    return false;
  }
  return read.chunk && read.chunk->head.identity == work.identity &&
         read.chunk->head.place.first == place.first && read.chunk->head.place.count == place.count &&
         read.chunk->head.columns.size() == work.columns.size();
}

bool make_chunk(const std::filesystem::path& folder, const ChunkWork& work, const ChunkPlace& place,
                const Ensemble::Progress& progress) {
  const std::filesystem::path file = folder / file_name_of(work.identity, place);
  if (is_done(file, work, place)) return false;
  // Opened before the work, so that a folder that takes no file is known of at once.
  text::NewFile out(file);
  out.append(to_bytes(run_chunk(work, place, progress)));
  out.commit();
  return true;
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  const char* what = "no folder can be made here";
  std::filesystem::create_directories(folder, error);
  if (!error && !std::filesystem::is_directory(folder))
    error = std::make_error_code(std::errc::not_a_directory);
  if (!error && access(folder.c_str(), W_OK | X_OK) != 0) {
    error = std::error_code(errno, std::generic_category());
    what = "no chunk can be written here";
  }
  if (error)
    throw text::ReadError(text::Diagnostic{{folder.string(), {}},
                                           fmt::format("{}: {}", what, error.message()),
                                           "a folder for the chunks, which you may write to",
                                           "name another one, or see to its permissions"});
}

std::uint64_t usual_chunks(std::uint64_t runs) {
  constexpr std::uint64_t kRuns = 1000, kMost = 1000;
  return std::clamp<std::uint64_t>((runs + kRuns - 1) / kRuns, 1, kMost);
}

}  // namespace oblique::ensemble
