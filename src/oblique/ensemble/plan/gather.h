// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <oblique/ensemble/plan/chunk_work.h>

namespace oblique::ensemble {

/// What there is of an ensemble in a folder of chunks.
struct Gathering {
  struct Part {
    std::filesystem::path file;
    ChunkHead head;
  };
  struct Damaged {
    std::filesystem::path file;
    std::string trouble;
    bool is_ours = false;  ///< by its name; else it is in nobody's way, and nothing replaces it
  };
  /// Some runs of a part; the next ones begin where they end.
  struct Piece {
    std::size_t part = 0;  ///< index in `parts`
    std::uint64_t first = 0;
    std::uint64_t count = 0;
  };

  std::vector<Part> parts;       ///< whole and unharmed
  std::vector<Damaged> damaged;  ///< to be made anew
  std::vector<Piece> pieces;     ///< which runs are taken from where
  std::vector<ChunkPlace> missing;
  std::uint64_t runs_there = 0;
  std::uint64_t chunks = 0;  ///< into how many the ensemble was cut; 0: no chunk is there

  bool complete() const { return missing.empty() && chunks > 0; }
  /// Of the parts that are taken.
  EnsembleCount count() const;
  /// The machines that failed, in order, with the reason of each.
  std::vector<std::pair<std::uint64_t, std::string>> failures() const;
};

/// Looks through a folder for the chunks of an ensemble (files that end in .chunk). A chunk that is damaged
/// counts as missing. One of something else (another plan, subject or version) does not belong there: the
/// first of each kind is thrown in a PlanError, with how many there are. The chunks may be of an ensemble
/// that was cut in several ways.
Gathering look_through(const std::filesystem::path& folder, const Identity& identity, std::uint64_t runs,
                       std::size_t columns);

/// Writes the table of all runs, in order; the gathering is complete. Throws ReadError where a chunk has
/// changed since it was looked at.
void write_table(const Gathering& gathering, const std::vector<text::TableColumn>& columns,
                 const std::filesystem::path& table);

/// The rows of all runs, one after the other.
std::vector<double> rows_of(const Gathering& gathering, std::size_t columns);

}  // namespace oblique::ensemble
