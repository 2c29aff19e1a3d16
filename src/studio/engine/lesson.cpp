// SPDX-License-Identifier: MIT
#include "studio/engine/lesson.h"

#include <algorithm>

#include <fmt/format.h>

#include <oblique/diagram/expectations.h>
#include <oblique/diagram/flatten.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/report/atlas/lesson_check.h>
#include <oblique/report/expectation_check.h>

namespace oblique::studio {
namespace {

std::vector<diagram::Expectation> wanted(const diagram::Diagram& diagram, const Options& options) {
  constexpr int kMostSteps = 1000;
  if (const auto step = options.whole("step", 1, kMostSteps))
    return report::lesson_step(diagram, *step).expectations;
  if (diagram.lesson && diagram.lesson->question) return diagram.lesson->question->expectations;
  throw text::ReadError(text::Diagnostic{
      {diagram.file, {}}, "this diagram asks no question", "[lesson.question], or 'step'", {}});
}

}  // namespace

Json lesson_of(const diagram::Lesson& lesson) {
  Json json{{"title", lesson.title}, {"text", lesson.text}, {"steps", Json::array()}, {"question", nullptr}};
  for (const diagram::LessonStep& step : lesson.steps) {
    Json set = Json::array();
    for (const diagram::ParameterOverride& one : step.set)
      set.push_back({{"name", one.path}, {"value", one.value}});
    json["steps"].push_back({{"do", step.action},
                             {"guess", step.guess},
                             {"set", std::move(set)},
                             {"see", step.see},
                             {"checked", !step.expectations.empty()}});
  }
  if (lesson.question) {
    json["question"] = {
        {"ask", lesson.question->ask}, {"answer", lesson.question->answer}, {"hint", lesson.question->hint}};
  }
  return json;
}

Json checked_lesson(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                    const Options& options, solve::RunOptions how) {
  const std::vector<diagram::Expectation> expected = wanted(diagram, options);
  std::vector<diagram::ParameterOverride> settings;
  for (auto& [path, value] : options.settings("set")) settings.push_back({path, value});
  const diagram::FlatDiagram flat = diagram::flatten(diagram, library, settings);
  const network::Program program(network::assemble(flat));
  report::ask_for_expectations(expected, diagram.file, how);
  const std::vector<report::ExpectationResult> results =
      report::check_expectations(expected, solve::run(program, flat, how));
  Json json{{"met", std::all_of(results.begin(), results.end(), [](const auto& one) { return one.met; })},
            {"checks", Json::array()}};
  for (const report::ExpectationResult& one : results) {
    json["checks"].push_back({{"what", diagram::expectation_key(one.expectation)},
                              {"actual", one.actual},
                              {"value", one.expectation.value},
                              {"within", one.expectation.within},
                              {"met", one.met}});
  }
  return json;
}

}  // namespace oblique::studio
