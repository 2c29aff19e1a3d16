// SPDX-License-Identifier: MIT
#include <oblique/ensemble/plan/identity.h>

#include <algorithm>
#include <charconv>
#include <system_error>

#include <fmt/format.h>

#include <oblique/ensemble/plan/fingerprint.h>
#include <oblique/text/document.h>
#include <oblique/text/file.h>

namespace oblique::ensemble {
namespace {

/// Adds the files that a text names: `file = "data.csv"` in any of its tables. What is no file there is
/// reported by who reads the text.
void add_named_files(const text::Value& value, const std::filesystem::path& folder,
                     Fingerprint& fingerprint) {
  for (const text::Value& element : value.elements) add_named_files(element, folder, fingerprint);
  for (const text::Entry& entry : value.entries) {
    if (entry.key == "file" && entry.value.kind == text::Value::Kind::string) {
      const std::filesystem::path path = folder / entry.value.text;
      std::error_code none;
      if (std::filesystem::is_regular_file(path, none))
        fingerprint.add(entry.value.text, text::read_file(path));
    }
    add_named_files(entry.value, folder, fingerprint);
  }
}

void add_file(const std::string& name, const std::string& text, const std::filesystem::path& file,
              Fingerprint& fingerprint) {
  fingerprint.add(name, text);
  add_named_files(text::parse_document(text, file.string()).root, file.parent_path(), fingerprint);
}

/// Without what does not change a number.
std::string settings_of(Plan plan) {
  plan.subject = "subject";
  return write_plan({{}, {}, std::move(plan)}, {});
}

}  // namespace

Identity identity_of(const Plan& plan, const std::string& text,
                     const std::vector<std::filesystem::path>& folders, const std::string& version) {
  Fingerprint subject, blocks;
  add_file("subject", text, plan.subject, subject);
  for (const std::filesystem::path& folder : folders) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().extension() == ".toml") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    for (const std::filesystem::path& file : files)
      add_file(file.filename().string(), text::read_file(file), file, blocks);
  }
  return {version, fingerprint_of(settings_of(plan)), subject.text(), blocks.text()};
}

ChunkPlace chunk_place(std::uint64_t number, std::uint64_t chunks, std::uint64_t runs) {
  const auto refuse = [&](std::string what, std::string expected) {
    throw PlanError(
        text::Diagnostic{{{}, {}, text::Setting{"chunk"}}, std::move(what), std::move(expected), {}});
  };
  const std::uint64_t most = std::min(runs, kMostChunks);
  if (chunks == 0 || chunks > most)
    refuse(fmt::format("an ensemble of {} {} is not cut into {} chunks", runs, runs == 1 ? "run" : "runs",
                       chunks),
           fmt::format("from 1 to {} chunks", most));
  if (number > chunks)
    refuse(fmt::format("there is no chunk {} of {}", number, chunks),
           fmt::format("a number from 0 to {}, or from 1 to {}", chunks - 1, chunks));
  number %= chunks;
  // floor(k·runs/chunks), without a product that is too large
  const auto from = [&](std::uint64_t k) { return k * (runs / chunks) + k * (runs % chunks) / chunks; };
  return {number, chunks, from(number), from(number + 1) - from(number)};
}

ChunkPlace parse_chunk_place(const std::string& text, std::uint64_t runs) {
  std::uint64_t number = 0, chunks = 0;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, number);
  if (first.ec == std::errc() && first.ptr != end && *first.ptr == '/') {
    const auto second = std::from_chars(first.ptr + 1, end, chunks);
    if (second.ec == std::errc() && second.ptr == end) return chunk_place(number, chunks, runs);
  }
  throw PlanError(text::Diagnostic{{{}, {}, text::Setting{"chunk"}},
                                   fmt::format("'{}' is no part of an ensemble", text),
                                   "i/n, the i-th of n chunks, such as 3/16",
                                   {}});
}

std::string name_of(const ChunkPlace& place) {
  const std::string name = fmt::format("{}/{}", place.number, place.chunks);
  return place.number > 0 ? name : name + fmt::format(" (that is {}/{})", place.chunks, place.chunks);
}

std::string file_name_of(const Identity& identity, const ChunkPlace& place) {
  const std::string place_text =
      fmt::format("{}/{}: {} from {}", place.number, place.chunks, place.count, place.first);
  const std::string fingerprint = Fingerprint()
                                      .add("version", identity.version)
                                      .add("plan", identity.plan)
                                      .add("subject", identity.subject)
                                      .add("blocks", identity.blocks)
                                      .add("place", place_text)
                                      .text();
  return fmt::format("{}-of-{}-{}.chunk", place.number, place.chunks, fingerprint);
}

}  // namespace oblique::ensemble
