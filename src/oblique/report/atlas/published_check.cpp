// SPDX-License-Identifier: MIT
#include <oblique/report/atlas/published_check.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <oblique/diagram/flatten.h>
#include <oblique/diagram/published.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/report/expectation_check.h>

namespace oblique::report {
namespace {

using Values = std::vector<diagram::PublishedValue>;

std::vector<diagram::Expectation> expectations_with(const Values& values,
                                                    const std::vector<diagram::ParameterOverride>& set) {
  std::vector<diagram::Expectation> expectations;
  for (const diagram::PublishedValue& value : values) {
    if (value.set == set) expectations.push_back(value.expected);
  }
  return expectations;
}

}  // namespace

double PublishedResult::in_uncertainties() const {
  return std::abs(actual - value.expected.value) / value.expected.within;
}

std::vector<diagram::Expectation> published_expectations(const diagram::Diagram& diagram) {
  if (!diagram.published) return {};
  return expectations_with(diagram.published->values, {});
}

std::vector<PublishedResult> check_published(const diagram::Diagram& diagram,
                                             const diagram::BlockLibrary& library,
                                             const std::vector<diagram::ParameterOverride>& overrides,
                                             const solve::Run& run) {
  std::vector<PublishedResult> results;
  if (!diagram.published) return results;
  const Values& values = diagram.published->values;
  for (const diagram::PublishedValue& value : values) results.push_back({value, std::nan(""), {}});
  std::vector<bool> done(values.size(), false);
  for (std::size_t first = 0; first < values.size(); ++first) {
    if (done[first]) continue;
    const auto& set = values[first].set;
    const std::vector<diagram::Expectation> expectations = expectations_with(values, set);
    std::vector<diagram::ParameterOverride> settings = overrides;
    settings.insert(settings.end(), set.begin(), set.end());
    std::vector<ExpectationResult> found;
    if (set.empty()) {
      found = check_expectations(expectations, run);
    } else {
      solve::Run own = run_with(diagram, library, settings, expectations);
      found = check_expectations(expectations, own);
      results[first].warnings = std::move(own.warnings);
    }
    std::size_t next = 0;
    for (std::size_t k = first; k < values.size(); ++k) {
      if (values[k].set != set) continue;
      results[k].actual = found[next++].actual / values[k].factor;
      done[k] = true;
    }
  }
  return results;
}

solve::Run run_with(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                    const std::vector<diagram::ParameterOverride>& settings,
                    const std::vector<diagram::Expectation>& expectations) {
  const diagram::FlatDiagram flat = diagram::flatten(diagram, library, settings);
  solve::RunOptions options = solve::options_of(diagram.run);
  ask_for_expectations(expectations, diagram.file, options);
  return solve::run(network::Program(network::assemble(flat)), flat, options);
}

std::string warnings_text(const std::vector<PublishedResult>& results, const text::Vocabulary& vocabulary) {
  std::string text;
  for (const PublishedResult& result : results) {
    for (const text::Diagnostic& warning : result.warnings)
      text += fmt::format("warning: in the run for {}: {}\n", diagram::name_of(result.value),
                          text::to_string(warning, vocabulary));
  }
  return text;
}

std::string number_within(double value, double within) {
  constexpr int kLeast = 3, kMost = 17;
  const double told_apart = std::log10(std::abs(value) / within);
  const int digits = std::isfinite(told_apart)
                         ? std::clamp(static_cast<int>(std::floor(told_apart)) + 3, kLeast, kMost)
                         : kLeast;
  if (std::isnan(value)) return "not known";
  return std::abs(value) < within / 1000 ? "0" : fmt::format("{:.{}g}", value, digits);
}

std::string to_text(const std::vector<PublishedResult>& results) {
  std::string text;
  for (const PublishedResult& result : results) {
    const diagram::PublishedValue& value = result.value;
    const char* const verdict = result.met() ? "ok    " : result.is_known() ? "known " : "FAILED";
    text += fmt::format("{}  {} = {}, published {} ± {}{}: off by {:.2g} times that\n", verdict,
                        diagram::name_of(value), number_within(result.actual, value.expected.within),
                        value.expected.value, value.expected.within,
                        value.unit.empty() ? "" : " " + value.unit, result.in_uncertainties());
    if (!result.met() && !value.because.empty()) text += fmt::format("        because {}\n", value.because);
    if (!result.met() && !value.tried.empty())
      text += fmt::format("        not explained; tried: {}\n", value.tried);
  }
  return text;
}

}  // namespace oblique::report
