// SPDX-License-Identifier: MIT
#include <oblique/ensemble/study/levels.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

#include <oblique/text/expression.h>
#include <oblique/text/nearest_decimal.h>
#include <oblique/text/trimmed.h>

namespace oblique::ensemble {
namespace {

constexpr std::size_t kMostValues = 1'000'000;

[[noreturn]] void fail(std::string what, std::string expected = {}, std::string remedy = {}) {
  throw text::ExpressionError{0, std::move(what), std::move(expected), std::move(remedy)};
}

/// The parts between separators that stand in no parenthesis.
std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  int depth = 0;
  std::size_t begin = 0;
  for (std::size_t k = 0; k <= text.size(); ++k) {
    if (k < text.size() && text[k] == '(') ++depth;
    if (k < text.size() && text[k] == ')') --depth;
    if (k < text.size() && (text[k] != separator || depth > 0)) continue;
    parts.push_back(text::trimmed(text.substr(begin, k - begin)));
    begin = k + 1;
  }
  return parts;
}

double value_of(std::string_view text, const text::Unit& unit) {
  double value = 0;
  try {
    value = text::parse_quantity(text, unit);
  } catch (const text::ExpressionError& error) {
    fail(fmt::format("'{}': {}", text, error.what), error.expected, error.remedy);
  }
  if (std::isnan(value)) fail(fmt::format("'{}' is not a number", text), "a number");
  return value;
}

struct Range {
  double from = 0, to = 0;
  std::size_t count = 0;  ///< 0: not given
  bool logarithmic = false;

  double at(double place) const {
    if (place <= 0) return from;
    if (place >= 1) return to;
    return logarithmic ? from * std::pow(to / from, place) : from + (to - from) * place;
  }
};

std::optional<std::size_t> count_of(std::string_view text) {
  std::size_t count = 0;
  for (const char digit : text) {
    if (digit < '0' || digit > '9' || count > kMostValues) return std::nullopt;
    count = 10 * count + static_cast<std::size_t>(digit - '0');
  }
  return text.empty() ? std::nullopt : std::optional(count);
}

Range range_of(std::string_view text, const text::Unit& unit) {
  const std::vector<std::string_view> parts = split(text, ':');
  const std::size_t dots = parts[0].find("..");
  if (dots == std::string_view::npos)
    fail(fmt::format("'{}' has a ':' and no range before it", text), "from..to:values");
  Range range;
  const std::string_view to = text::trimmed(parts[0].substr(dots + 2));
  range.from = value_of(text::with_unit_of(text::trimmed(parts[0].substr(0, dots)), to), unit);
  range.to = value_of(to, unit);
  for (std::size_t k = 1; k < parts.size(); ++k) {
    const auto count = count_of(parts[k]);
    if (parts[k] == "log" && !range.logarithmic) {
      range.logarithmic = true;
    } else if (count && *count >= 2 && *count <= kMostValues && range.count == 0) {
      range.count = *count;
    } else {
      fail(fmt::format("'{}' in '{}' is no number of values", parts[k], text),
           fmt::format("a whole number from 2 to {}, and ':log' for even steps of the logarithm",
                       kMostValues));
    }
  }
  if (!std::isfinite(range.from) || !std::isfinite(range.to))
    fail(fmt::format("the range '{}' has no end", text), "finite bounds",
         "'inf' may stand alone in a list: 1e4,1e6,inf");
  if (range.logarithmic && !(range.from * range.to > 0)) {
    fail(fmt::format("a logarithmic range cannot go from {} to {}", range.from, range.to),
         "both bounds above 0, or both below");
  }
  if (range.from == range.to)
    fail(fmt::format("the range '{}' has equal bounds", text), "two bounds",
         fmt::format("the value alone: {}", parts[0].substr(0, dots)));
  return range;
}

}  // namespace

Levels::Levels(std::string_view text, const text::Unit& unit) {
  const std::vector<std::string_view> parts = split(text, ',');
  if (text::trimmed(text).empty())
    fail("there are no values", "a list such as 1,2,5, or a range such as 0.8..1.2:9");
  for (const std::string_view part : parts) {
    if (part.empty()) fail(fmt::format("'{}' has a comma and no value beside it", text), "a value");
    if (part.find("..") == std::string_view::npos && part.find(':') == std::string_view::npos) {
      grid_.push_back(value_of(part, unit));
      continue;
    }
    const Range range = range_of(part, unit);
    if (parts.size() == 1) {
      is_range_ = true;
      logarithmic_ = range.logarithmic;
      from_ = range.from;
      to_ = range.to;
    } else if (range.count == 0) {
      fail(fmt::format("the range '{}' of a list does not say how many values it has", part),
           fmt::format("'{}:5', for example", part));
    }
    for (std::size_t k = 0; k < range.count; ++k) {
      // 1e2..1e6:5:log is 100, 1000 … to the last digit
      constexpr int kDigits = 15;
      const double place = static_cast<double>(k) / static_cast<double>(range.count - 1);
      const bool inside = k > 0 && k + 1 < range.count;
      grid_.push_back(inside ? text::nearest_decimal(range.at(place), kDigits) : range.at(place));
    }
    if (grid_.size() > kMostValues) fail(fmt::format("there are more than {} values", kMostValues));
  }
}

double Levels::lowest() const {
  return is_range_ ? std::min(from_, to_) : *std::min_element(grid_.begin(), grid_.end());
}

double Levels::highest() const {
  return is_range_ ? std::max(from_, to_) : *std::max_element(grid_.begin(), grid_.end());
}

double Levels::at(double place) const {
  if (is_range_) return Range{from_, to_, 0, logarithmic_}.at(place);
  const auto count = static_cast<double>(grid_.size());
  return grid_[static_cast<std::size_t>(std::clamp(std::floor(place * count), 0.0, count - 1))];
}

}  // namespace oblique::ensemble
