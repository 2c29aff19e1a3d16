// SPDX-License-Identifier: MIT
#include <oblique/ensemble/plan/gather.h>

#include <algorithm>
#include <functional>
#include <map>
#include <span>
#include <system_error>

#include <fmt/format.h>

#include <oblique/text/file.h>

namespace oblique::ensemble {
namespace {

/// Why a chunk does not belong to an ensemble; empty where it does.
text::Diagnostic stranger(const std::filesystem::path& file, const ChunkHead& head,
                          const Identity& identity) {
  text::Diagnostic found{{file.string(), {}}, {}, {}, {}};
  const char* const elsewhere =
      "move this chunk to another folder, or gather those of the plan from one of their own";
  if (head.identity.version != identity.version) {
    found.what = fmt::format("this chunk is of version {} of the program", head.identity.version);
    found.expected =
        fmt::format("version {}, which reads it: another one may give other numbers", identity.version);
    found.remedy = "gather it with the version that made it, or delete it and run the chunk again";
  } else if (head.identity.subject != identity.subject) {
    found.what = "this chunk is of another diagram or mechanism, or of an earlier state of it";
    found.expected = "chunks of the file that the plan names, as it is now";
    found.remedy = elsewhere;
  } else if (head.identity.plan != identity.plan) {
    found.what = "this chunk is of another plan";
    found.expected = "chunks with just the settings and the seed of the plan";
    found.remedy = elsewhere;
  } else if (head.identity.blocks != identity.blocks) {
    found.what = "this chunk is of a run with other further blocks";
    found.expected = "the same folders of blocks as now";
    found.remedy = text::Remedy{"give the same ", text::Setting{"blocks"}, ", or run the chunk again"};
  }
  return found;
}

std::vector<std::filesystem::path> chunk_files(const std::filesystem::path& folder) {
  std::error_code error;
  std::vector<std::filesystem::path> files;
  for (auto at = std::filesystem::directory_iterator(folder, error);
       !error && at != std::filesystem::directory_iterator(); at.increment(error)) {
    if (at->path().extension() == ".chunk") files.push_back(at->path());
  }
  if (error)
    throw text::ReadError(text::Diagnostic{{folder.string(), {}},
                                           fmt::format("cannot read the chunks here: {}", error.message()),
                                           "a folder with chunks of the plan",
                                           {}});
  std::sort(files.begin(), files.end());
  return files;
}

/// Into how many chunks an ensemble was cut of which this is the file of one, by its name; 0: it is none.
std::uint64_t chunks_by_name(const std::filesystem::path& file, const Identity& identity,
                             std::uint64_t runs) {
  const std::string name = file.filename().string();  // NUMBER-of-CHUNKS-….chunk
  const std::size_t of = name.find("-of-");
  if (of == std::string::npos) return 0;
  const std::uint64_t number = std::strtoull(name.c_str(), nullptr, 10);
  const std::uint64_t chunks = std::strtoull(name.c_str() + of + 4, nullptr, 10);
  const bool can_be = chunks > 0 && chunks <= std::min(runs, kMostChunks) && number < chunks;
  return can_be && name == file_name_of(identity, chunk_place(number, chunks, runs)) ? chunks : 0;
}

/// Takes runs from the parts, in order, always from the one that reaches farthest.
void choose_pieces(Gathering& gathering, std::uint64_t runs) {
  std::vector<std::size_t> order(gathering.parts.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  const auto begin_of = [&](std::size_t k) { return gathering.parts[k].head.place.first; };
  const auto end_of = [&](std::size_t k) { return begin_of(k) + gathering.parts[k].head.place.count; };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return begin_of(a) < begin_of(b); });
  std::uint64_t at = 0;
  for (std::size_t next = 0; at < runs;) {
    std::size_t best = order.size();
    for (; next < order.size() && begin_of(order[next]) <= at; ++next) {
      if (best == order.size() || end_of(order[next]) > end_of(best)) best = order[next];
    }
    if (best < order.size() && end_of(best) > at) {
      gathering.pieces.push_back({best, at, end_of(best) - at});
      gathering.runs_there += end_of(best) - at;
      at = end_of(best);
    } else if (next < order.size()) {
      at = std::max(at, begin_of(order[next]));
    } else {
      break;
    }
  }
}

/// The chunks with runs that are not there, of the way of cutting that most of those that are there have.
void find_missing(Gathering& gathering, const Identity& identity, std::uint64_t runs) {
  std::map<std::uint64_t, std::size_t> ways;
  for (const Gathering::Part& part : gathering.parts) ++ways[part.head.place.chunks];
  for (const Gathering::Damaged& one : gathering.damaged) {
    if (one.is_ours) ++ways[chunks_by_name(one.file, identity, runs)];
  }
  std::size_t most = 0;
  for (const auto& [chunks, times] : ways) {
    if (times < most) continue;
    most = times;
    gathering.chunks = chunks;
  }
  std::size_t piece = 0;
  for (std::uint64_t k = 0; k < gathering.chunks; ++k) {
    const ChunkPlace place = chunk_place(k, gathering.chunks, runs);
    const auto& pieces = gathering.pieces;
    std::uint64_t at = place.first;
    while (at < place.first + place.count) {
      while (piece < pieces.size() && pieces[piece].first + pieces[piece].count <= at) ++piece;
      if (piece == pieces.size() || pieces[piece].first > at) break;
      at = pieces[piece].first + pieces[piece].count;
    }
    if (at < place.first + place.count) gathering.missing.push_back(place);
  }
}

/// Hands over the rows of each piece, in order.
void for_each_piece(const Gathering& gathering, std::size_t columns,
                    const std::function<void(std::span<const double>)>& take) {
  std::size_t read_part = gathering.parts.size();
  Chunk chunk;
  for (const Gathering::Piece& piece : gathering.pieces) {
    const Gathering::Part& part = gathering.parts[piece.part];
    if (read_part != piece.part) {
      ReadChunk read = parse_chunk(text::read_file(part.file));
      if (!read.chunk || read.chunk->head.identity != part.head.identity ||
          read.chunk->head.place.first != part.head.place.first ||
          read.chunk->head.place.count != part.head.place.count)
        throw text::ReadError(text::Diagnostic{{part.file.string(), {}},
                                               "this chunk was changed while it was gathered",
                                               {},
                                               "gather again when nothing writes to the folder"});
      chunk = std::move(*read.chunk);
      read_part = piece.part;
    }
    take(std::span(chunk.rows)
             .subspan((piece.first - part.head.place.first) * columns, piece.count * columns));
  }
}

}  // namespace

EnsembleCount Gathering::count() const {
  EnsembleCount all;
  for (const Piece& piece : pieces) {
    all += parts[piece.part].head.count;
  }
  all.failed = failures().size();
  return all;
}

std::vector<std::pair<std::uint64_t, std::string>> Gathering::failures() const {
  std::vector<std::pair<std::uint64_t, std::string>> all;
  for (const Piece& piece : pieces) {
    for (const auto& failure : parts[piece.part].head.failures) {
      if (failure.first >= piece.first && failure.first < piece.first + piece.count) all.push_back(failure);
    }
  }
  return all;
}

Gathering look_through(const std::filesystem::path& folder, const Identity& identity, std::uint64_t runs,
                       std::size_t columns) {
  Gathering gathering;
  std::vector<std::pair<text::Diagnostic, std::size_t>> strangers;  // of each kind one, and how many more
  const auto add_damaged = [&](const std::filesystem::path& file, std::string trouble) {
    gathering.damaged.push_back({file, std::move(trouble), chunks_by_name(file, identity, runs) > 0});
  };
  for (const std::filesystem::path& file : chunk_files(folder)) {
    ReadChunk read = parse_chunk(text::read_file(file));
    if (!read.chunk) {
      add_damaged(file, std::move(read.trouble));
      continue;
    }
    ChunkHead& head = read.chunk->head;
    if (text::Diagnostic found = stranger(file, head, identity); !found.what.empty()) {
      const auto alike = std::find_if(strangers.begin(), strangers.end(),
                                      [&](const auto& one) { return one.first.what == found.what; });
      if (alike == strangers.end()) {
        strangers.emplace_back(std::move(found), 0);
      } else {
        ++alike->second;
      }
    } else if (head.columns.size() != columns || head.place.count > runs ||
               head.place.first > runs - head.place.count) {
      add_damaged(file, "it has other columns or runs than the plan");
    } else {
      gathering.parts.push_back({file, std::move(head)});
    }
  }
  text::Diagnostics findings;
  for (auto& [found, more] : strangers) {
    if (more > 0)
      found.what += fmt::format(", and so {} {} more in the folder", more == 1 ? "is" : "are", more);
    findings.add(std::move(found));
  }
  findings.throw_if_any<PlanError>();
  choose_pieces(gathering, runs);
  find_missing(gathering, identity, runs);
  return gathering;
}

void write_table(const Gathering& gathering, const std::vector<text::TableColumn>& columns,
                 const std::filesystem::path& table) {
  text::TableFile file(table, columns, gathering.runs_there);
  for_each_piece(gathering, columns.size(), [&](std::span<const double> rows) { file.add(rows); });
  file.finish();
}

std::vector<double> rows_of(const Gathering& gathering, std::size_t columns) {
  std::vector<double> all;
  all.reserve(gathering.runs_there * columns);
  for_each_piece(gathering, columns,
                 [&](std::span<const double> rows) { all.insert(all.end(), rows.begin(), rows.end()); });
  return all;
}

}  // namespace oblique::ensemble
