// SPDX-License-Identifier: MIT
#include <oblique/diagram/expectations.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <oblique/diagram/machine_profile.h>
#include <oblique/text/toml_text.h>

namespace oblique::diagram {
namespace {

constexpr std::string_view kAt = " at ", kMaximum = " maximum", kMinimum = " minimum", kPeriod = " period";

/// Times may exceed the end of the run by rounding: "300 ms" is not quite 0.3 s.
constexpr double kRounding = 1e-12;

/// Splits the key of an expectation; false where it has none of their forms.
bool split_key(const text::Entry& entry, const std::string& what, double until, Expectation& expectation,
               text::Diagnostics& diagnostics) {
  const std::string& key = entry.key;
  const std::string& file = expectation.place.file;
  for (const auto& [word, kind] :
       {std::pair{kMaximum, Expectation::Kind::maximum}, std::pair{kMinimum, Expectation::Kind::minimum},
        std::pair{kPeriod, Expectation::Kind::period}}) {
    if (!key.ends_with(word) || key.size() == word.size()) continue;
    expectation.kind = kind;
    expectation.output = key.substr(0, key.size() - word.size());
    return true;
  }
  const std::size_t at = key.rfind(kAt);
  if (at == std::string::npos || at == 0) {
    diagnostics.add({expectation.place,
                     fmt::format("{} cannot read '{}'", what, key),
                     R"("OUTPUT at TIME", "OUTPUT maximum", "OUTPUT minimum" or "OUTPUT period")",
                     {}});
    return false;
  }
  expectation.kind = Expectation::Kind::at_time;
  expectation.output = key.substr(0, at);
  text::Value time;
  time.kind = text::Value::Kind::string;
  time.text = key.substr(at + kAt.size());
  time.position = entry.position;
  time.position.column += static_cast<int>(at + kAt.size());
  const auto seconds =
      read_expected_time(file, time, expectation.place, fmt::format("time of '{}'", key), until, diagnostics);
  if (seconds) expectation.time = *seconds;
  return seconds.has_value();
}

/// Reports every expectation of `what` about no output.
void check_outputs(const std::vector<Expectation>& expectations, const std::string& what,
                   const std::vector<std::string>& outputs, text::Diagnostics& diagnostics) {
  for (const Expectation& expectation : expectations) {
    if (std::find(outputs.begin(), outputs.end(), expectation.output) != outputs.end()) continue;
    diagnostics.add({expectation.place,
                     fmt::format("{} names '{}', which is no output", what, expectation.output),
                     {},
                     text::suggest(expectation.output, outputs)});
  }
}

}  // namespace

std::optional<double> read_expected_time(const std::string& file, const text::Value& time,
                                         const text::Place& place, const std::string& what, double until,
                                         text::Diagnostics& diagnostics) {
  const auto seconds = text::read_quantity(file, time, "s", what, diagnostics);
  if (!seconds) return std::nullopt;
  if (*seconds >= 0 && *seconds <= until * (1 + kRounding)) return std::min(*seconds, until);
  diagnostics.add({place, fmt::format("{} is {} s", what, *seconds),
                   fmt::format("a time from 0 to the end of the run, {} s", until),
                   "name a time within the run, or lengthen 'until' of [run]"});
  return std::nullopt;
}

text::Unit unit_of(const Diagram& diagram, const Expectation& expectation) {
  if (expectation.kind == Expectation::Kind::period) return text::parse_unit("s").value();
  const auto found = std::find_if(diagram.outputs.begin(), diagram.outputs.end(),
                                  [&](const OutputSpec& spec) { return spec.name == expectation.output; });
  const std::string unit = found == diagram.outputs.end() ? OutputSpec{}.unit : found->unit;
  return unit_on(diagram.machine.profile, unit);
}

std::vector<Expectation> read_expectations(const Diagram& diagram, const text::Value& table,
                                           const std::string& what, double until,
                                           text::Diagnostics& diagnostics) {
  const std::string& file = diagram.file;
  std::vector<Expectation> expectations;
  for (const text::Entry& entry : table.entries) {
    Expectation expectation;
    expectation.text = entry.key;
    expectation.place = {file, entry.position};
    const bool good_key = split_key(entry, what, until, expectation, diagnostics);
    text::TableReader reader(file, entry.value, fmt::format("{} '{}'", what, entry.key), diagnostics);
    if (entry.value.kind != text::Value::Kind::table) continue;
    const auto expected = text::read_expected_value(reader, unit_of(diagram, expectation));
    if (!good_key || !expected) continue;
    expectation.value = expected->value;
    expectation.within = expected->within;
    expectations.push_back(std::move(expectation));
  }
  return expectations;
}

std::string expectation_key(const Expectation& expectation) {
  switch (expectation.kind) {
    case Expectation::Kind::maximum:
      return fmt::format("{}{}", expectation.output, kMaximum);
    case Expectation::Kind::minimum:
      return fmt::format("{}{}", expectation.output, kMinimum);
    case Expectation::Kind::period:
      return fmt::format("{}{}", expectation.output, kPeriod);
    case Expectation::Kind::at_time:
      break;
  }
  return fmt::format("{}{}{}", expectation.output, kAt, expectation.time);
}

std::vector<std::pair<std::string, std::string>> expectation_lines(
    const std::vector<Expectation>& expectations) {
  std::vector<std::pair<std::string, std::string>> lines;
  lines.reserve(expectations.size());
  for (const Expectation& expectation : expectations) {
    const std::string key = expectation.text.empty() ? expectation_key(expectation) : expectation.text;
    lines.emplace_back(text::toml_string(key),
                       fmt::format("{{ value = {}, within = {} }}", expectation.value, expectation.within));
  }
  return lines;
}

void check_expected_outputs(const Diagram& diagram, const std::vector<std::string>& outputs,
                            text::Diagnostics& diagnostics) {
  check_outputs(diagram.expectations, "[expect]", outputs, diagnostics);
  if (diagram.published) {
    for (const PublishedValue& value : diagram.published->values)
      check_outputs({value.expected}, "[[published.value]]", outputs, diagnostics);
    for (const std::string& name : diagram.published->plot) {
      if (name == "t" || std::find(outputs.begin(), outputs.end(), name) != outputs.end()) continue;
      diagnostics.add({diagram.published->place,
                       fmt::format("'plot' of [published] names '{}', which is no output", name),
                       {},
                       text::suggest(name, outputs)});
    }
  }
  if (!diagram.lesson) return;
  for (std::size_t k = 0; k < diagram.lesson->steps.size(); ++k)
    check_outputs(diagram.lesson->steps[k].expectations,
                  fmt::format("'expect' of step {} in [lesson]", k + 1), outputs, diagnostics);
  if (diagram.lesson->question)
    check_outputs(diagram.lesson->question->expectations, "'expect' of [lesson.question]", outputs,
                  diagnostics);
}

}  // namespace oblique::diagram
