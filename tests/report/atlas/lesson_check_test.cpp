// SPDX-License-Identifier: MIT
#include <oblique/report/atlas/lesson_check.h>

#include <gtest/gtest.h>

#include "../../support/compiled.h"

namespace oblique::report {
namespace {

using testing::message_of;

diagram::Diagram asking(const std::string& lesson) {
  return diagram::parse_diagram(testing::diagram_text("x = { type = \"constant\" }\n", lesson), "d.toml");
}

const std::string kQuestion = R"toml([lesson.question]
ask = """
  How much
is it?
"""
answer = "x.value"
expect = { "x at 1" = { value = 3, within = 0.1 } }
)toml";

std::string verdict(const diagram::Diagram& d, double actual, bool met) {
  const diagram::LessonQuestion& question = *d.lesson->question;
  return verdict_text(question, {{question.expectations.at(0), actual, met}});
}

TEST(LessonQuestion, IsAnsweredBySettingItsParameter) {
  const diagram::Diagram d = asking(kQuestion);
  EXPECT_TRUE(is_answered(d, {{"y.value", "1"}, {"x.value", "1"}}));
  EXPECT_FALSE(is_answered(d, {{"y.value", "1"}}));
  EXPECT_FALSE(is_answered(asking(""), {{"x.value", "1"}}));
  EXPECT_FALSE(is_answered(asking("[lesson]\n"), {{"x.value", "1"}}));
}

TEST(LessonQuestion, IsAnsweredInWords) {
  const diagram::Diagram plain = asking(kQuestion), hinted = asking(kQuestion + "hint = \"Count\\n it.\"\n");
  EXPECT_EQ(open_question_text(plain), "open    question: How much is it? (answer by setting x.value)\n");
  EXPECT_EQ(verdict(plain, 3, true), "right   question: How much is it?\n");
  EXPECT_EQ(verdict(plain, 2, false),
            "wrong   question: How much is it?\n        your answer gives x at 1 = 2\n");
  EXPECT_EQ(verdict(hinted, 3, true), "right   question: How much is it?\n");
  EXPECT_EQ(
      verdict(hinted, 2, false),
      "wrong   question: How much is it?\n        your answer gives x at 1 = 2\n        hint: Count it.\n");
  EXPECT_EQ(open_question_text(asking("")), "");
}

TEST(LessonSteps, CountFromOne) {
  const std::string step = "[[lesson.step]]\nsee = \"it\"\ndo = ";
  const diagram::Diagram two = asking(step + "\"a\"\n" + step + "\"b\"\n"), one = asking(step + "\"a\"\n");
  EXPECT_EQ(lesson_step(two, 1).action, "a");
  EXPECT_EQ(lesson_step(two, 2).action, "b");
  const auto message = [](const diagram::Diagram& d, int number) {
    return message_of<diagram::DiagramError>([&] { lesson_step(d, number); });
  };
  EXPECT_EQ(message(two, 3),
            "d.toml: there is no step 3: the lesson has 2 steps; expected a number from 1 to 2");
  EXPECT_EQ(message(two, 0),
            "d.toml: there is no step 0: the lesson has 2 steps; expected a number from 1 to 2");
  EXPECT_EQ(message(one, 2), "d.toml: there is no step 2: the lesson has 1 step; expected 1");
  EXPECT_EQ(
      message(asking(""), 1),
      "d.toml: there is no step 1: the diagram has no [[lesson.step]]; expected the diagram of a lesson");
}

}  // namespace
}  // namespace oblique::report
