// SPDX-License-Identifier: MIT
#include <oblique/text/diagnostic.h>

#include <algorithm>
#include <ostream>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace oblique::text {

const Vocabulary& plain_vocabulary() {
  static const Vocabulary plain{[](const Setting& setting) {
                                  return setting.value.empty()
                                             ? fmt::format("'{}'", setting.name)
                                             : fmt::format("{} {}", setting.name, setting.value);
                                },
                                [](const Action& action) {
                                  return action.subject.empty()
                                             ? fmt::format("'{}'", action.name)
                                             : fmt::format("'{} {}'", action.name, action.subject);
                                }};
  return plain;
}

Remedy::Remedy(std::string words) {
  if (!words.empty()) pieces_.emplace_back(std::move(words));
}

Remedy::Remedy(const char* words) : Remedy(std::string(words)) {}

Remedy::Remedy(std::string_view words) : Remedy(std::string(words)) {}

Remedy& Remedy::operator+=(const Remedy& more) {
  pieces_.insert(pieces_.end(), more.pieces_.begin(), more.pieces_.end());
  return *this;
}

std::string Remedy::words(const Vocabulary& vocabulary) const {
  struct Speller {
    const Vocabulary& vocabulary;
    std::string operator()(const std::string& words) const { return words; }
    std::string operator()(const Setting& setting) const { return vocabulary.setting(setting); }
    std::string operator()(const Action& action) const { return vocabulary.action(action); }
  };
  std::string all;
  for (const Piece& piece : pieces_) all += std::visit(Speller{vocabulary}, piece);
  return all;
}

std::ostream& operator<<(std::ostream& out, const Remedy& remedy) {
  return out << remedy.words();
}

std::string to_string(const Diagnostic& diagnostic, const Vocabulary& vocabulary) {
  std::string text;
  const SourcePosition at = diagnostic.place.position;
  if (!diagnostic.place.file.empty()) {
    text += diagnostic.place.file + ":";
    if (at.line > 0) text += fmt::format("{}:{}:", at.line, at.column);
    text += " ";
  }
  if (!diagnostic.place.setting.name.empty()) text += vocabulary.setting(diagnostic.place.setting) + ": ";
  text += diagnostic.what;
  if (!diagnostic.expected.empty()) text += "; expected " + diagnostic.expected;
  if (!diagnostic.remedy.empty()) text += "\n  remedy: " + diagnostic.remedy.words(vocabulary);
  return text;
}

Error::Error(std::vector<Diagnostic> diagnostics) : diagnostics_(std::move(diagnostics)) {
  for (const Diagnostic& diagnostic : diagnostics_) {
    if (!message_.empty()) message_ += "\n";
    message_ += to_string(diagnostic);
  }
}

Error::Error(Diagnostic diagnostic) : Error(std::vector{std::move(diagnostic)}) {}

void Diagnostics::sort_by_place() {
  const auto key = [](const Diagnostic& d) {
    return std::tie(d.place.file, d.place.position.line, d.place.position.column);
  };
  std::stable_sort(items_.begin(), items_.end(),
                   [&](const Diagnostic& a, const Diagnostic& b) { return key(a) < key(b); });
}

namespace {

/// Letters to insert, drop, replace, or exchange with their neighbour to make `b` of `a` (optimal string
/// alignment), or more than `most` where that many do not do: only what is so near to the diagonal is looked
/// at (E. Ukkonen, Algorithms for approximate string matching, 1985).
std::size_t edit_distance(std::string_view a, std::string_view b, std::size_t most) {
  if (a.size() > b.size() + most || b.size() > a.size() + most) return most + 1;
  std::vector<std::size_t> before_last(b.size() + 1, most + 1);
  std::vector<std::size_t> last(b.size() + 1, most + 1);
  std::vector<std::size_t> row(b.size() + 1, most + 1);
  for (std::size_t j = 0; j <= std::min(most, b.size()); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(before_last, last);
    std::swap(last, row);
    const std::size_t first = i > most ? i - most : 1;
    const std::size_t end = std::min(b.size(), i + most);
    row[first - 1] = first == 1 ? std::min(i, most + 1) : most + 1;
    std::size_t least = row[first - 1];
    for (std::size_t j = first; j <= end; ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({replaced, last[j] + 1, row[j - 1] + 1, most + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before_last[j - 2] + 1);
      }
      least = std::min(least, row[j]);
    }
    if (end < b.size()) row[end + 1] = most + 1;  // of an earlier row
    if (least > most) return most + 1;
  }
  return row.back();
}

}  // namespace

std::optional<std::string> nearest_name(std::string_view name, const std::vector<std::string>& candidates) {
  constexpr std::size_t kMostSlips = 20;  // however long the name is
  const std::size_t allowed = std::clamp<std::size_t>(name.size() / 3, 1, kMostSlips);
  std::optional<std::string> best;
  std::size_t best_distance = allowed + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(name, candidate, best_distance - 1);
    if (distance < best_distance && distance < candidate.size()) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

std::string suggest(std::string_view name, const std::vector<std::string>& candidates) {
  if (const auto nearest = nearest_name(name, candidates)) return fmt::format("did you mean '{}'?", *nearest);
  if (candidates.empty()) return {};
  constexpr std::size_t kMostNames = 12;
  const std::size_t shown = std::min(candidates.size(), kMostNames);
  std::vector<std::string> names = candidates;
  if (shown < names.size()) {  // of a list that is cut, first those that hold the name
    std::stable_partition(names.begin(), names.end(), [&](const std::string& candidate) {
      return candidate.find(name) != std::string::npos;
    });
  }
  std::string text = fmt::format(
      "known: {}", fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(shown), ", "));
  if (shown < candidates.size()) text += fmt::format(" and {} more", candidates.size() - shown);
  return text;
}

}  // namespace oblique::text
