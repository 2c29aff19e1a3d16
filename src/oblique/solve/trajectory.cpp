// SPDX-License-Identifier: MIT
#include <oblique/solve/trajectory.h>

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

namespace oblique {
namespace {

/// A field of a CSV file; quoted where it has to be (RFC 4180).
std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + "\"";
}

}  // namespace

std::optional<std::size_t> Trajectory::find(std::string_view column) const {
  const auto found =
      std::find_if(columns_.begin(), columns_.end(), [&](const Column& c) { return c.name == column; });
  if (found == columns_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - columns_.begin());
}

std::string to_csv(const Trajectory& trajectory) {
  fmt::memory_buffer text;
  auto out = std::back_inserter(text);
  for (std::size_t c = 0; c < trajectory.columns().size(); ++c) {
    fmt::format_to(out, "{}{}", c == 0 ? "" : ",", csv_field(trajectory.columns()[c].name));
  }
  text.push_back('\n');
  for (std::size_t r = 0; r < trajectory.rows(); ++r) {
    const auto row = trajectory.row(r);
    for (std::size_t c = 0; c < row.size(); ++c) fmt::format_to(out, "{}{}", c == 0 ? "" : ",", row[c]);
    text.push_back('\n');
  }
  return fmt::to_string(text);
}

}  // namespace oblique
