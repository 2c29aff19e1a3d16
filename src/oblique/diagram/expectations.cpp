// SPDX-License-Identifier: MIT
#include <oblique/diagram/expectations.h>

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include <fmt/format.h>

#include <oblique/diagram/machine_profile.h>

namespace oblique::diagram {
namespace {

constexpr std::string_view kAt = " at ", kMaximum = " maximum", kMinimum = " minimum";

/// Times may exceed the end of the run by rounding: "300 ms" is not quite 0.3 s.
constexpr double kRounding = 1e-12;

/// Splits the key of an expectation; false where it has not one of the three forms.
bool split_key(const text::Entry& entry, double until, Expectation& expectation,
               text::Diagnostics& diagnostics) {
  const std::string& key = entry.key;
  const std::string& file = expectation.place.file;
  for (const auto& [word, kind] :
       {std::pair{kMaximum, Expectation::Kind::maximum}, std::pair{kMinimum, Expectation::Kind::minimum}}) {
    if (!key.ends_with(word) || key.size() == word.size()) continue;
    expectation.kind = kind;
    expectation.output = key.substr(0, key.size() - word.size());
    return true;
  }
  const std::size_t at = key.rfind(kAt);
  if (at == std::string::npos || at == 0) {
    diagnostics.add({expectation.place,
                     fmt::format("[expect] cannot read '{}'", key),
                     R"("OUTPUT at TIME", "OUTPUT maximum" or "OUTPUT minimum")",
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
  const auto seconds = text::read_quantity(file, time, "s", fmt::format("time of '{}'", key), diagnostics);
  if (!seconds) return false;
  if (!(*seconds >= 0 && *seconds <= until * (1 + kRounding))) {
    diagnostics.add({expectation.place, fmt::format("time of '{}' is {} s", key, *seconds),
                     fmt::format("a time from 0 to the end of the run, {} s", until),
                     "name a time within the run, or lengthen 'until' of [run]"});
    return false;
  }
  expectation.time = std::min(*seconds, until);
  return true;
}

/// The unit of an output, in which what is expected of it may be given; "1" where it is any text for people.
text::Unit unit_of(const Diagram& diagram, std::string_view output) {
  const auto found = std::find_if(diagram.outputs.begin(), diagram.outputs.end(),
                                  [&](const OutputSpec& spec) { return spec.name == output; });
  const std::string unit = found == diagram.outputs.end() ? OutputSpec{}.unit : found->unit;
  return unit_on(diagram.machine.profile, unit);
}

}  // namespace

std::vector<Expectation> read_expectations(const Diagram& diagram, const text::Value& table, double until,
                                           text::Diagnostics& diagnostics) {
  const std::string& file = diagram.file;
  std::vector<Expectation> expectations;
  for (const text::Entry& entry : table.entries) {
    Expectation expectation;
    expectation.text = entry.key;
    expectation.place = {file, entry.position};
    const bool good_key = split_key(entry, until, expectation, diagnostics);
    text::TableReader reader(file, entry.value, fmt::format("[expect] '{}'", entry.key), diagnostics);
    if (entry.value.kind != text::Value::Kind::table) continue;
    const auto expected = text::read_expected_value(reader, unit_of(diagram, expectation.output));
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
    case Expectation::Kind::at_time:
      break;
  }
  return fmt::format("{}{}{}", expectation.output, kAt, expectation.time);
}

void check_expected_outputs(const std::vector<Expectation>& expectations,
                            const std::vector<std::string>& outputs, text::Diagnostics& diagnostics) {
  const std::unordered_set<std::string_view> known(outputs.begin(), outputs.end());
  for (const Expectation& expectation : expectations) {
    if (known.contains(expectation.output)) continue;
    diagnostics.add({expectation.place,
                     fmt::format("[expect] names '{}', which is no output", expectation.output),
                     {},
                     text::suggest(expectation.output, outputs)});
  }
}

}  // namespace oblique::diagram
