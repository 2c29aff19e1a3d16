// SPDX-License-Identifier: MIT
#include <oblique/diagram/lesson.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>

#include "small_library.h"

namespace oblique::diagram {
namespace {

using testing::diagram_text;
using ::testing::HasSubstr;
using testing::message_of;
using testing::small_library;

const std::string kTaught = R"toml(a = { type = "reference" }
b = { type = "adder", in = ["a", "2*a"] }
[run]
until = 2
[outputs]
x = "b"
[lesson]
)toml";  // what follows stands from line 10 on

Diagram taught(const std::string& rest) {
  return parse_diagram(diagram_text(kTaught, rest), "d.toml");
}

std::string taught_message(const std::string& rest) {
  return message_of([&] { flatten(taught(rest), small_library()); });
}

std::string step_message(const std::string& rest) {
  return taught_message("[[lesson.step]]\ndo = \"turn\"\nsee = \"it turns\"\n" + rest);
}

std::string question_message(const std::string& rest) {
  return taught_message("[lesson.question]\nask = \"why?\"\n" + rest);
}

TEST(Lesson, IsReadWhole) {
  const Diagram d = taught(R"toml(title = "Lesson 1"
text = """
Of sums.

And more."""
[[lesson.step]]
do = "run it"
see = "3"
[[lesson.step]]
do = "turn a"
guess = "what will it be?"
set = { "a.value" = 0.25, "b.in[2]" = "-1/2", "b.gain" = inf }
see = "something else"
expect = { "x at 1" = { value = 0.125, within = 1e-3 } }
[lesson.question]
ask = "What gives 1?"
answer = "a.value"
hint = "a third"
[lesson.question.expect]
"x at 2" = { value = 1, within = 0.01 }
"x maximum" = { value = 1, within = 0.01 }
)toml");
  const Lesson& lesson = d.lesson.value();
  EXPECT_EQ(lesson.title, "Lesson 1");
  EXPECT_EQ(lesson.text, "Of sums.\n\nAnd more.");
  ASSERT_EQ(lesson.steps.size(), 2U);
  EXPECT_EQ(lesson.steps[0], (LessonStep{"run it", "", {}, "3", {}}));
  EXPECT_EQ(lesson.steps[1], (LessonStep{"turn a",
                                         "what will it be?",
                                         {{"a.value", "0.25"}, {"b.in[2]", "-1/2"}, {"b.gain", "inf"}},
                                         "something else",
                                         {{"x at 1", "x", Expectation::Kind::at_time, 1, 0.125, 1e-3, {}}}}));
  const LessonQuestion& question = lesson.question.value();
  EXPECT_EQ(question.ask, "What gives 1?");
  EXPECT_EQ(question.answer, "a.value");
  EXPECT_EQ(question.hint, "a third");
  ASSERT_EQ(question.expectations.size(), 2U);
  EXPECT_EQ(question.expectations[1],
            (Expectation{"x maximum", "x", Expectation::Kind::maximum, 0, 1, 0.01, {}}));
}

TEST(Lesson, StepsSayWhatToDoAndWhatToSee) {
  EXPECT_EQ(taught_message("[[lesson.step]]\n"),
            "d.toml:10:1: step 1 in [lesson] has no 'do'; expected what the learner is to do\n"
            "d.toml:10:1: step 1 in [lesson] has no 'see'; expected what is then to be seen");
  EXPECT_EQ(taught_message("[[lesson.step]]\ndo = \" \"\nsee = \"it\"\n"),
            "d.toml:11:6: 'do' of step 1 in [lesson] is empty; expected what the learner is to do");
  EXPECT_EQ(taught_message("step = 3\n"),
            "d.toml:10:8: 'step' of [lesson] is a number; expected tables [[lesson.step]]");
  EXPECT_EQ(taught_message("steps = 3\n"),
            "d.toml:10:1: unknown key 'steps' in [lesson]\n  remedy: did you mean 'step'?");
}

TEST(Lesson, RefusesToSetWhatIsNotThere) {
  EXPECT_EQ(step_message("set = { \"a.value\" = 1, \"b.in[2]\" = 0 }\n"), "");
  EXPECT_EQ(
      step_message("set = { \"a.valu\" = 1 }\n"),
      "d.toml:13:9: 'valu' of block type 'reference' is not a parameter\n  remedy: did you mean 'value'?");
  EXPECT_EQ(step_message("set = { \"b.in[3]\" = 1 }\n"),
            "d.toml:13:9: input 'b.in' has no wire 3; expected a number from 1 to 2");
  EXPECT_EQ(step_message("set = { a = 1 }\n"),
            "d.toml:13:9: 'a' is a block, not one of its values; expected a.value");
  EXPECT_EQ(step_message("set = { \"a.value\" = true }\n"),
            "d.toml:13:21: 'a.value' in 'set' of step 1 in [lesson] is true or false; expected a number or a "
            "quantity");
}

TEST(Lesson, ChecksWhatItExpects) {
  EXPECT_EQ(step_message("expect = { \"y at 1\" = { value = 1, within = 1 } }\n"),
            "d.toml:13:12: 'expect' of step 1 in [lesson] names 'y', which is no output\n"
            "  remedy: known: x");
  EXPECT_EQ(step_message("expect = { \"x at 3\" = { value = 1, within = 1 } }\n"),
            "d.toml:13:12: time of 'x at 3' is 3 s; expected a time from 0 to the end of the run, 2 s\n"
            "  remedy: name a time within the run, or lengthen 'until' of [run]");
  EXPECT_THAT(step_message("expect = { x = { value = 1, within = 1 } }\n"),
              HasSubstr("d.toml:13:12: 'expect' of step 1 in [lesson] cannot read 'x'"));
  EXPECT_EQ(question_message("answer = \"a.value\"\nexpect = { \"y at 1\" = { value = 1, within = 1 } }\n"),
            "d.toml:13:12: 'expect' of [lesson.question] names 'y', which is no output\n"
            "  remedy: known: x");
}

TEST(Lesson, QuestionsCanBeAnswered) {
  const std::string expect = "expect = { \"x at 1\" = { value = 1, within = 1 } }\n";
  EXPECT_EQ(question_message("answer = \"a.value\"\n" + expect), "");
  EXPECT_EQ(question_message("answer = \"b.in[2]\"\n" + expect), "");
  EXPECT_EQ(question_message("answer = \"a.value\"\n"),
            "d.toml:10:1: nothing in [lesson.question] tells a right answer from a wrong one; expected "
            "[lesson.question.expect]: what the run gives where the answer is right, as in [expect]");
  EXPECT_THAT(question_message("answer = \"a.value\"\nexpect = {}\n"),
              HasSubstr("d.toml:13:10: nothing in [lesson.question] tells a right answer"));
  EXPECT_EQ(question_message(expect),
            "d.toml:10:1: [lesson.question] has no 'answer'; expected the parameter that the learner sets, "
            "\"block.parameter\"");
  EXPECT_EQ(question_message("answer = \"c.value\"\n" + expect),
            "d.toml:12:10: there is no block 'c'\n  remedy: known: a, b");
  EXPECT_EQ(question_message("answer = \"a.valu\"\n" + expect),
            "d.toml:12:10: 'valu' of block type 'reference' is not a parameter\n"
            "  remedy: did you mean 'value'?");
  EXPECT_EQ(question_message("answer = \"b.in[7]\"\n" + expect),
            "d.toml:12:10: input 'b.in' has no wire 7; expected a number from 1 to 2");
  EXPECT_EQ(question_message("answer = \"a\"\n" + expect),
            "d.toml:12:10: 'a' is a block, not one of its values; expected a.value");
}

}  // namespace
}  // namespace oblique::diagram
