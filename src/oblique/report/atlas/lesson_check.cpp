// SPDX-License-Identifier: MIT
#include <oblique/report/atlas/lesson_check.h>

#include <algorithm>

#include <fmt/format.h>

#include <oblique/diagram/expectations.h>
#include <oblique/report/text_table.h>

namespace oblique::report {
namespace {

/// A text of several lines as one.
std::string one_line(const std::string& text) {
  std::string line;
  bool gap = false;
  for (const char c : text) {
    if (c == ' ' || c == '\t' || c == '\n' || c == '\r') {
      gap = !line.empty();
      continue;
    }
    if (gap) line += ' ';
    gap = false;
    line += c;
  }
  return line;
}

}  // namespace

bool is_answered(const diagram::Diagram& diagram, const std::vector<diagram::ParameterOverride>& settings) {
  if (!diagram.lesson || !diagram.lesson->question) return false;
  return std::any_of(settings.begin(), settings.end(), [&](const diagram::ParameterOverride& setting) {
    return setting.path == diagram.lesson->question->answer;
  });
}

std::string open_question_text(const diagram::Diagram& diagram) {
  if (!diagram.lesson || !diagram.lesson->question) return {};
  const diagram::LessonQuestion& question = *diagram.lesson->question;
  return fmt::format("open    question: {} (answer by setting {})\n", one_line(question.ask),
                     question.answer);
}

std::string verdict_text(const diagram::LessonQuestion& question,
                         const std::vector<ExpectationResult>& results) {
  const bool right = std::all_of(results.begin(), results.end(), [](const auto& r) { return r.met; });
  std::string text = fmt::format("{}   question: {}\n", right ? "right" : "wrong", one_line(question.ask));
  if (right) return text;
  for (const ExpectationResult& result : results) {
    if (!result.met)
      text += fmt::format("        your answer gives {} = {}\n", diagram::expectation_key(result.expectation),
                          short_number(result.actual));
  }
  if (!question.hint.empty()) text += fmt::format("        hint: {}\n", one_line(question.hint));
  return text;
}

const diagram::LessonStep& lesson_step(const diagram::Diagram& diagram, int number) {
  const std::size_t n = diagram.lesson ? diagram.lesson->steps.size() : 0;
  if (number >= 1 && static_cast<std::size_t>(number) <= n)
    return diagram.lesson->steps[static_cast<std::size_t>(number) - 1];
  throw diagram::DiagramError(text::Diagnostic{
      {diagram.file, {}},
      n == 0 ? fmt::format("there is no step {}: the diagram has no [[lesson.step]]", number)
             : fmt::format("there is no step {}: the lesson has {}", number, count(n, "step", "steps")),
      n == 0   ? "the diagram of a lesson"
      : n == 1 ? "1"
               : fmt::format("a number from 1 to {}", n),
      {}});
}

}  // namespace oblique::report
