// SPDX-License-Identifier: MIT
#include <oblique/diagram/lesson.h>

#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <oblique/diagram/expectations.h>
#include <oblique/diagram/published.h>
#include <oblique/text/toml_text.h>

namespace oblique::diagram {
namespace {

class LessonReader {
 public:
  LessonReader(const Diagram& diagram, const text::Value& table, double until, text::Diagnostics& diagnostics)
      : diagram_(diagram),
        until_(until),
        diagnostics_(diagnostics),
        reader_(diagram.file, table, "[lesson]", diagnostics) {}

  Lesson read() {
    lesson_.title = reader_.string("title").value_or("");
    lesson_.text = reader_.string("text").value_or("");
    constexpr std::string_view kSteps = "step";  // a key, which only happens to be a block's name too
    if (const text::Value* const steps = reader_.find(kSteps)) read_steps(*steps);
    if (const text::Value* const question = reader_.table("question")) read_question(*question);
    reader_.finish();
    return std::move(lesson_);
  }

 private:
  void read_steps(const text::Value& steps) {
    if (steps.kind != text::Value::Kind::array) {
      reader_.report("step", fmt::format("'step' of [lesson] is {}", text::kind_name(steps.kind)),
                     "tables [[lesson.step]]");
      return;
    }
    for (const text::Value& element : steps.elements) read_step(element);
  }

  void read_step(const text::Value& table) {
    const std::string what = fmt::format("step {} in [lesson]", lesson_.steps.size() + 1);
    LessonStep& step = lesson_.steps.emplace_back();
    text::TableReader reader(diagram_.file, table, what, diagnostics_);
    step.action = words(reader, "do", "what the learner is to do");
    step.guess = reader.string("guess").value_or("");
    step.see = words(reader, "see", "what is then to be seen");
    if (const text::Value* const set = reader.table("set"))
      step.set = read_settings(diagram_.file, *set, fmt::format("'set' of {}", what), diagnostics_);
    if (const text::Value* const expect = reader.table("expect"))
      step.expectations =
          read_expectations(diagram_, *expect, fmt::format("'expect' of {}", what), until_, diagnostics_);
    reader.finish();
  }

  void read_question(const text::Value& table) {
    LessonQuestion& question = lesson_.question.emplace();
    text::TableReader reader(diagram_.file, table, "[lesson.question]", diagnostics_);
    question.ask = words(reader, "ask", "the question in words");
    question.answer = words(reader, "answer", "the parameter that the learner sets, \"block.parameter\"");
    question.hint = reader.string("hint").value_or("");
    const text::Value* const answer = table.find("answer");
    question.place = {diagram_.file, answer == nullptr ? table.position : answer->position};
    if (const text::Value* const expect = reader.table("expect"))
      question.expectations =
          read_expectations(diagram_, *expect, "'expect' of [lesson.question]", until_, diagnostics_);
    const text::Value* const expect = table.find("expect");
    const bool is_table = expect != nullptr && expect->kind == text::Value::Kind::table;
    if (expect == nullptr || (is_table && expect->entries.empty())) {
      reader.report("expect", "nothing in [lesson.question] tells a right answer from a wrong one",
                    "[lesson.question.expect]: what the run gives where the answer is right, as in [expect]");
    }
    reader.finish();
  }

  /// A text that must stand there and say something.
  std::string words(text::TableReader& reader, std::string_view key, std::string_view expected) {
    const auto text = reader.required_string(key, expected);
    if (text && text->find_first_not_of(" \t\r\n") == std::string::npos)
      reader.report(key, fmt::format("'{}' of {} is empty", key, reader.what()), std::string(expected));
    return text.value_or("");
  }

  const Diagram& diagram_;
  double until_;
  text::Diagnostics& diagnostics_;
  text::TableReader reader_;
  Lesson lesson_;
};

void write_expectations(const std::vector<Expectation>& expectations, std::string& out) {
  if (expectations.empty()) return;
  out += "expect = { ";
  for (const auto& [key, value] : expectation_lines(expectations))
    out += fmt::format("{}{} = {}", out.ends_with("{ ") ? "" : ", ", key, value);
  out += " }\n";
}

}  // namespace

Lesson read_lesson(const Diagram& diagram, const text::Value& table, double until,
                   text::Diagnostics& diagnostics) {
  return LessonReader(diagram, table, until, diagnostics).read();
}

std::string write_lesson(const Lesson& lesson) {
  std::string out = "\n[lesson]\n";
  const auto line = [&out](std::string_view key, const std::string& text) {
    out += fmt::format("{} = {}\n", key, text::toml_string(text));
  };
  if (!lesson.title.empty()) line("title", lesson.title);
  if (!lesson.text.empty()) line("text", lesson.text);
  for (const LessonStep& step : lesson.steps) {
    out += "\n[[lesson.step]]\n";
    line("do", step.action);
    if (!step.guess.empty()) line("guess", step.guess);
    if (!step.set.empty()) out += "set = " + settings_text(step.set) + "\n";
    line("see", step.see);
    write_expectations(step.expectations, out);
  }
  if (!lesson.question) return out;
  out += "\n[lesson.question]\n";
  line("ask", lesson.question->ask);
  line("answer", lesson.question->answer);
  if (!lesson.question->hint.empty()) line("hint", lesson.question->hint);
  write_expectations(lesson.question->expectations, out);
  return out;
}

}  // namespace oblique::diagram
