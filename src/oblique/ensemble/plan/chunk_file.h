// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <oblique/ensemble/engine/ensemble.h>
#include <oblique/ensemble/plan/identity.h>

namespace oblique::ensemble {

/// What a chunk says of itself.
struct ChunkHead {
  Identity identity;
  ChunkPlace place;
  std::vector<std::string> columns;  ///< their names
  EnsembleCount count;
  std::vector<std::pair<std::uint64_t, std::string>> failures;  ///< numbers of machines, and why they failed
};

/// The rows of a part of an ensemble.
struct Chunk {
  ChunkHead head;
  std::vector<double> rows;  ///< `place.count` rows, one after the other
};

/// A chunk as the bytes of a file: a line with the format and the fingerprint of all that follows, the head
/// in TOML, a line "---", the rows as numbers of 8 bytes, the least significant one first.
std::string to_bytes(const Chunk& chunk);

/// A chunk of its bytes, or what is wrong with them, in a line: they are no chunk, or not all of one.
struct ReadChunk {
  std::optional<Chunk> chunk;
  std::string trouble;
};
ReadChunk parse_chunk(std::string_view bytes);

}  // namespace oblique::ensemble
