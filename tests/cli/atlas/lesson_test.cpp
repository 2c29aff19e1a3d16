// SPDX-License-Identifier: MIT
// What `run --check` says of what was published and of lessons.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../verbs.h"

namespace oblique::test {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

class LessonVerbs : public Verbs {
 protected:
  /// x = (x₀ − a) e^(−t) + a, after 20 s a.
  std::string with(const std::string& rest) const {
    std::ofstream(file("x.toml")) << "format = \"oblique-diagram/1\"\n[run]\nuntil = 20\n[blocks]\n"
                                     "answer = { type = \"constant\", value = 0.2 }\n"
                                     "x = { type = \"integrator\", in = [\"answer\", \"-x\"] }\n"
                                     "[outputs]\nx = \"x\"\n"
                                  << rest;
    return file("x.toml");
  }
};

const std::string kExpect = "[expect]\n\"x at 20\" = { value = 0.2, within = 1e-6 }\n";
const std::string kQuestion =
    "[lesson.question]\nask = \"Where must it rest?\"\nanswer = \"answer.value\"\nhint = \"Think.\"\n"
    "expect = { \"x at 20\" = { value = 0.75, within = 0.01 } }\n";
const std::string kStep =
    "[[lesson.step]]\ndo = \"double it\"\nset = { \"answer.value\" = 0.4 }\nsee = \"twice as much\"\n";

TEST_F(LessonVerbs, RunHoldsWhatWasPublished) {
  const std::string published =
      "[published]\nauthor = \"A\"\ntitle = \"T\"\n"
      "[[published.value]]\nname = \"x\"\nvalue = 0.21\nwithin = 0.02\n"
      "[[published.value]]\nname = \"x\"\nvalue = 0.4\nwithin = 0.05\nset = { \"answer.value\" = 0.5 }\n";
  Outcome outcome = oblique("run " + with(kExpect + published) + " --check");
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("\nok      x at 20 = 0.19999"));
  EXPECT_THAT(
      outcome.out,
      EndsWith(
          "ok      x at end = 0.2, published 0.21 ± 0.02: off by 0.5 times that\n"
          "FAILED  x at end with answer.value = 0.5 = 0.5, published 0.4 ± 0.05: off by 2 times that\n"));
  outcome = oblique("run " + with(published + "because = \"it was read too early\"\n") + " --check");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              EndsWith("known   x at end with answer.value = 0.5 = 0.5, published 0.4 ± 0.05: off by 2 "
                       "times that\n        because it was read too early\n"));
}

TEST_F(LessonVerbs, RunSaysRightAndWrong) {
  const std::string run = "run " + with(kExpect + kQuestion) + " --check";
  const Outcome open = oblique(run);
  EXPECT_EQ(open.status, 0);
  EXPECT_THAT(open.out, HasSubstr("\nok      x at 20 = 0.19999"));
  EXPECT_THAT(open.out,
              EndsWith("\nopen    question: Where must it rest? (answer by setting answer.value)\n"));
  const Outcome wrong = oblique(run + " --set answer.value=0.7");
  EXPECT_EQ(wrong.status, 1);
  EXPECT_THAT(wrong.out,
              EndsWith("\n\nwrong   question: Where must it rest?\n        your answer gives x at 20 = 0.7\n"
                       "        hint: Think.\n"));
  EXPECT_THAT(wrong.out, Not(HasSubstr("expected")));  // the answer is not given away
  const Outcome right = oblique(run + " --set answer.value=3/4");
  EXPECT_EQ(right.status, 0);
  EXPECT_THAT(right.out, EndsWith("\n\nright   question: Where must it rest?\n"));
  const Outcome other = oblique(run + " --set x.rate=2");
  EXPECT_EQ(other.status, 0);
  EXPECT_THAT(other.out, HasSubstr("\nopen    question"));
  EXPECT_EQ(oblique("run " + with(kQuestion) + " --check").status, 0);
}

TEST_F(LessonVerbs, RunTakesAStep) {
  const std::string expect = "expect = { \"x at 20\" = { value = 0.4, within = 1e-6 } }\n";
  const std::string run = "run " + with(kExpect + kStep + expect + kStep) + " --step ";
  const Outcome good = oblique(run + "1 --check");
  EXPECT_EQ(good.status, 0) << good.err;
  EXPECT_THAT(good.out, HasSubstr("\n\nok      x at 20 = 0.39999"));
  const Outcome turned = oblique(run + "1 --check --set answer.value=0.5");  // goes before the step's
  EXPECT_EQ(turned.status, 1);
  EXPECT_THAT(turned.out, HasSubstr("FAILED  x at 20 = 0.49999"));
  const Outcome bare = oblique(run + "2");
  EXPECT_EQ(bare.status, 0);
  EXPECT_THAT(bare.out, HasSubstr("0.4\n"));
  const Outcome nothing = oblique(run + "2 --check");
  EXPECT_EQ(nothing.status, 2);
  EXPECT_THAT(
      nothing.err,
      HasSubstr("there is nothing to check: step 2 has no 'expect'; expected expect = { \"side at pi\" = { "
                "value = 0.7, within = 1e-4 } } in [[lesson.step]]"));
  const Outcome none = oblique(run + "3");
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err,
              HasSubstr("there is no step 3: the lesson has 2 steps; expected a number from 1 to 2"));
}

}  // namespace
}  // namespace oblique::test
