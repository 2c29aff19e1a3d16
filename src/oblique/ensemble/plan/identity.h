// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <oblique/ensemble/plan/plan_file.h>

namespace oblique::ensemble {

/// What the numbers of an ensemble depend on, each part as a fingerprint, so that a message can say which
/// one differs.
struct Identity {
  std::string version;  ///< of the program; with it come the shipped blocks and the profiles of machines
  std::string plan;     ///< all settings with the seed, without title and paths
  std::string subject;  ///< the diagram or mechanism and the files that it reads
  std::string blocks;   ///< further blocks
  bool operator==(const Identity&) const = default;
};

/// `text` is that of the subject, `folders` those of further blocks. Throws ReadError where a file of theirs
/// cannot be read.
Identity identity_of(const Plan& plan, const std::string& text,
                     const std::vector<std::filesystem::path>& folders, const std::string& version);

/// The runs of an ensemble that one chunk of `chunks` holds: `first` to `first + count − 1`.
struct ChunkPlace {
  std::uint64_t number = 0;  ///< from 0 on
  std::uint64_t chunks = 1;
  std::uint64_t first = 0;
  std::uint64_t count = 0;
};

/// The most chunks of an ensemble.
inline constexpr std::uint64_t kMostChunks = 1'000'000;

/// The chunk `number` of `chunks` that an ensemble is cut into evenly: the runs [number·runs/chunks,
/// (number + 1)·runs/chunks). Chunk n of n is another name of chunk 0 of n, so that who counts from 1 to n
/// meets every chunk as well as who counts from 0 to n − 1. Throws PlanError.
ChunkPlace chunk_place(std::uint64_t number, std::uint64_t chunks, std::uint64_t runs);
/// The same of "i/n".
ChunkPlace parse_chunk_place(const std::string& text, std::uint64_t runs);

/// "3/16"; the first one is "0/16 (that is 16/16)".
std::string name_of(const ChunkPlace& place);

/// The name of a chunk's file: "NUMBER-of-CHUNKS-FINGERPRINT.chunk", the fingerprint of all that decides
/// about its content.
std::string file_name_of(const Identity& identity, const ChunkPlace& place);

}  // namespace oblique::ensemble
