// SPDX-License-Identifier: MIT
#include <oblique/ensemble/plan/chunk_file.h>

#include <charconv>
#include <cstring>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/ensemble/plan/fingerprint.h>
#include <oblique/text/table_format.h>
#include <oblique/text/table_reader.h>
#include <oblique/text/toml_text.h>

namespace oblique::ensemble {
namespace {

constexpr std::string_view kFormat = "oblique-chunk/1 ";
constexpr std::string_view kEndOfHead = "\n---\n";

std::string head_text(const ChunkHead& head) {
  std::vector<std::string> columns;
  for (const std::string& name : head.columns) columns.push_back(text::toml_string(name));
  std::string out = fmt::format(
      "version = {}\nplan = \"{}\"\nsubject = \"{}\"\nblocks = \"{}\"\nnumber = {}\nchunks = {}\nfirst = "
      "{}\ncount = {}\ncolumns = [{}]\nin_lanes = {}\nby_cvodes = {}\nfailed = {}\n",
      text::toml_string(head.identity.version), head.identity.plan, head.identity.subject,
      head.identity.blocks, head.place.number, head.place.chunks, head.place.first, head.place.count,
      fmt::join(columns, ", "), head.count.in_lanes, head.count.by_cvodes, head.count.failed);
  if (head.count.coarse > 0)
    out += fmt::format("coarse = {}\ndoubt = {}\n", head.count.coarse, head.count.doubt);
  if (!head.count.reasons.empty()) out += "[reasons]\n";
  for (const auto& [reason, times] : head.count.reasons)
    out += fmt::format("{} = {}\n", text::toml_string(reason), times);
  if (head.count.first_warned) {
    out += fmt::format("[warnings]\nmachines = {}\nfirst = {}\nwhat = {}\n", head.count.warned,
                       head.count.first_warned->first, text::toml_string(head.count.first_warned->second));
  }
  if (!head.failures.empty()) out += "[failures]\n";
  for (const auto& [number, why] : head.failures)
    out += fmt::format("{} = {}\n", number, text::toml_string(why));
  return out;
}

class HeadReader {
 public:
  explicit HeadReader(const text::Value& table) : reader_("", table, "the chunk", diagnostics_) {}

  ChunkHead read() {
    ChunkHead head;
    head.identity = {string("version"), string("plan"), string("subject"), string("blocks")};
    head.place = {whole("number"), whole("chunks"), whole("first"), whole("count")};
    head.columns = reader_.strings("columns").value_or(std::vector<std::string>{});
    head.count.in_lanes = whole("in_lanes");
    head.count.by_cvodes = whole("by_cvodes");
    head.count.failed = whole("failed");
    head.count.coarse = static_cast<std::uint64_t>(reader_.quantity("coarse", "1").value_or(0));
    head.count.doubt = reader_.quantity("doubt", "1").value_or(0);
    if (const text::Value* const reasons = reader_.table("reasons")) {
      for (const text::Entry& entry : reasons->entries)
        head.count.reasons[entry.key] = static_cast<std::uint64_t>(entry.value.number);
    }
    if (const text::Value* const warnings = reader_.table("warnings")) {
      text::TableReader reader("", *warnings, "the chunk", diagnostics_);
      head.count.warned = static_cast<std::uint64_t>(reader.required_quantity("machines", "1").value_or(0));
      head.count.first_warned.emplace(
          static_cast<std::uint64_t>(reader.required_quantity("first", "1").value_or(0)),
          reader.required_string("what", "a text").value_or(""));
    }
    if (const text::Value* const failures = reader_.table("failures")) {
      for (const text::Entry& entry : failures->entries)
        head.failures.emplace_back(number_of(entry.key), entry.value.text);
    }
    diagnostics_.throw_if_any<PlanError>();
    return head;
  }

 private:
  std::string string(std::string_view key) { return reader_.required_string(key, "a text").value_or(""); }
  static std::uint64_t number_of(const std::string& key) {
    std::uint64_t number = 0;
    std::from_chars(key.data(), key.data() + key.size(), number);
    return number;
  }
  std::uint64_t whole(std::string_view key) {
    return static_cast<std::uint64_t>(reader_.required_quantity(key, "1").value_or(0));
  }

  text::Diagnostics diagnostics_;
  text::TableReader reader_;
};

}  // namespace

std::string to_bytes(const Chunk& chunk) {
  std::string content = head_text(chunk.head);
  content += kEndOfHead.substr(1);
  content += text::bytes_of(chunk.rows);
  return fmt::format("{}{}\n", kFormat, fingerprint_of(content)) + content;
}

ReadChunk parse_chunk(std::string_view bytes) {
  const std::size_t line = bytes.find('\n');
  if (!bytes.starts_with(kFormat) || line == std::string_view::npos) {
    if (bytes.empty()) return {{}, "the file is empty"};
    if (kFormat.starts_with(bytes.substr(0, kFormat.size()))) return {{}, "it ends in its first line"};
    if (bytes.starts_with("oblique-chunk/")) return {{}, "it is a chunk in a format of another version"};
    return {{}, "it is no chunk of an ensemble"};
  }
  const std::string_view content = bytes.substr(line + 1);
  if (bytes.substr(kFormat.size(), line - kFormat.size()) != fingerprint_of(content))
    return {{}, "it is not whole, or was changed: its bytes are not those that were written"};
  // From here on the bytes are those of a program that wrote chunks.
  const std::size_t end = content.find(kEndOfHead);
  if (end == std::string_view::npos) return {{}, "it has no head"};
  Chunk chunk;
  try {
    chunk.head = HeadReader(text::parse_document(content.substr(0, end + 1), "").root).read();
  } catch (const text::Error& error) {
    return {{}, "its head is not understood: " + error.diagnostics().front().what};
  }
  const std::string_view rows = content.substr(end + kEndOfHead.size());
  if (rows.size() != chunk.head.place.count * chunk.head.columns.size() * sizeof(double))
    return {{}, "it has not as many numbers as it says"};
  chunk.rows.resize(rows.size() / sizeof(double));
  // As `bytes_of` writes them.
  if (!rows.empty()) std::memcpy(chunk.rows.data(), rows.data(), rows.size());
  return {std::move(chunk), {}};
}

}  // namespace oblique::ensemble
