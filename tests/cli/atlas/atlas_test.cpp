// SPDX-License-Identifier: MIT
// `oblique atlas`, and `oblique report` on a diagram.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../verbs.h"

namespace oblique::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class AtlasVerbs : public Verbs {
 protected:
  void write(const std::string& name, const std::string& published) const {
    std::ofstream(file(name))
        << "format = \"oblique-diagram/1\"\n[blocks]\none = { type = \"constant\", value = 0.5 "
           "}\n"
        << published;
  }
  std::string folder() const { return file(""); }
};

const std::string kMet =
    "[published]\nauthor = \"A\"\ntitle = \"T\"\n[[published.value]]\nname = \"one\"\nvalue = 0.5\nwithin = "
    "0.1\n";
const std::string kMissed = kMet + "[[published.value]]\nname = \"one\"\nvalue = 0.75\nwithin = 0.1\n";

TEST_F(AtlasVerbs, AtlasPrintsTheTableOfAgreement) {
  write("met.toml", kMet);
  Outcome outcome = oblique("atlas " + folder());
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              HasSubstr("programme  value       published    ±          unit  computed  difference/±\n"
                        "met        one at end        0.5  0.1  machine unit       0.5             0\n"));
  EXPECT_THAT(outcome.err, HasSubstr("1 programme, 1 published value: 1 within"));
  write("missed.toml", kMissed);
  outcome = oblique("atlas " + folder());
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, HasSubstr("2.5  DIFFERS\n"));
}

TEST_F(AtlasVerbs, AtlasWritesASite) {
  write("met.toml", kMet);
  std::ofstream(file("studio.html")) << "a page";
  const std::string site = file("site/deep");
  const Outcome outcome = oblique("atlas " + folder() + " -o " + site + " --studio " + file("studio.html"));
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(bytes_of("site/deep/index.html"), HasSubstr("href=\"met.html\""));
  EXPECT_THAT(bytes_of("site/deep/met.html"), HasSubstr("href=\"../../studio.html#"));
  const Outcome beside =
      run_command("oblique atlas " + folder() + " -o new/site --studio studio.html", file("."));
  EXPECT_EQ(beside.status, 0) << beside.err;
  EXPECT_THAT(bytes_of("new/site/met.html"), HasSubstr("href=\"../../studio.html#"));
  const Outcome dark = oblique("atlas " + folder() + " -o " + site + " --theme dark");
  EXPECT_EQ(dark.status, 0) << dark.err;
  EXPECT_THAT(bytes_of("site/deep/met.html"), HasSubstr("color-scheme: dark"));
  EXPECT_THAT(bytes_of("site/deep/met.html"), Not(HasSubstr("studio.html")));
}

TEST_F(AtlasVerbs, AtlasRefusesWhatItCannotServe) {
  const Outcome nothing = oblique("atlas " + folder());
  EXPECT_EQ(nothing.status, 2);
  EXPECT_THAT(nothing.err, HasSubstr("no diagram in this folder says where it was published"));
  write("met.toml", kMet);
  const Outcome alone = oblique("atlas " + folder() + " --studio page.html");
  EXPECT_EQ(alone.status, 2);
  EXPECT_THAT(alone.err,
              HasSubstr("--studio is where pages lead to, and none are written; expected -o SITE beside it"));
  const Outcome missing =
      oblique("atlas " + folder() + " -o " + file("site") + " --studio " + file("none.html"));
  EXPECT_EQ(missing.status, 2);
  EXPECT_THAT(missing.err,
              HasSubstr("none.html: the page of the studio is not there; expected build/web/studio.html\n"
                        "  remedy: build it with ./bootstrap web"));
  const Outcome file_in_the_way = oblique("atlas " + folder() + " -o " + file("met.toml"));
  EXPECT_EQ(file_in_the_way.status, 2);
  EXPECT_THAT(file_in_the_way.err, HasSubstr("met.toml: cannot make this folder: "));
}

TEST_F(AtlasVerbs, ReportTakesADiagram) {
  const std::string out = file("page.html");
  const Outcome outcome = oblique("report diagrams/lessons/damped-oscillator.toml -o " + out);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  for (const char* const part :
       {">What it solves</h2>", ">Scaling</h2>", ">Against an independent solution</h2>"})
    EXPECT_THAT(bytes_of("page.html"), HasSubstr(part));
  for (const char* const option : {"--machine tr-10", "--gain 1e4", "--bandwidth 3", "--method gradient",
                                   "--split a,b,c", "--slower 5"}) {
    const Outcome refused =
        oblique(std::string("report diagrams/lessons/circle.toml -o ") + out + " " + option);
    EXPECT_EQ(refused.status, 2);
    EXPECT_THAT(refused.out, IsEmpty());
    EXPECT_THAT(refused.err, HasSubstr(std::string(option).substr(0, std::string(option).find(' ')) +
                                       " is about the patch of a mechanism, and this is a diagram"));
  }
}

}  // namespace
}  // namespace oblique::test
