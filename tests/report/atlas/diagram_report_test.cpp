// SPDX-License-Identifier: MIT
#include <oblique/report/atlas/diagram_report.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../support/compiled.h"

namespace oblique::report {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kReported = R"toml(# A ring of two integrators & a sign,
# drawn by many.
#
#     x″ = −x
#     y = −x′
#
# It turns.
format = "oblique-diagram/1"
title = "A <circle>"
source = "a book"
[machine]
profile = "tr-10"
[run]
until = 10
[blocks]
x = { type = "integrator", in = ["2*y"], initial = 0.5, label = "x/10" }
y = { type = "integrator", in = ["-0.5*x"] }
[outputs]
x = { signal = "x", scale = 10, unit = "V" }
y = { signal = "y", scale = 20, unit = "V" }
[expect]
"x minimum" = { value = -5, within = 0.1 }
)toml";

const std::string kReportedAsPublished = R"toml([published]
author = "A. Author"
title = "Rings"
year = 1960
address = "https://example.org/rings"
machine = "TR-10 no. 7"
errata = ["The sign is missing."]
plot = ["y", "x"]
[[published.value]]
name = "x"
value = 4.5
within = 0.1
at = "maximum"
because = "the ink was thick"
)toml";

std::string page_of(const std::string& text, const std::string& index = "", const std::string& studio = "") {
  const Programme programme = run_programme("ring.toml", text, testing::shipped_blocks());
  DiagramReport report{programme, testing::shipped_blocks()};
  report.index = index;
  report.studio = studio;
  return report.page().text(draw::Theme::automatic);
}

TEST(HeadComment, IsParagraphsAndFormulas) {
  EXPECT_THAT(head_comment(kReported), ElementsAre("A ring of two integrators & a sign, drawn by many.",
                                                   "    x″ = −x\n    y = −x′", "It turns."));
  EXPECT_THAT(head_comment("format = 3\n# late\n"), ElementsAre());
}

TEST(DiagramReport, HasAllThatIsKnownOfADiagram) {
  const std::string page = page_of(kReported);
  EXPECT_THAT(page, AllOf(HasSubstr("<h1>A &lt;circle&gt;</h1>"), HasSubstr("<p>a book.</p>"),
                          HasSubstr("A ring of two integrators &amp; a sign, drawn by many."),
                          HasSubstr("<pre>    x″ = −x\n")));
  // x = 10 x̂ and y = 20 ŷ, and the machine's integrators invert
  EXPECT_THAT(
      page,
      HasSubstr(
          "<pre><span>dx/dt = −y,   starting from 5</span><span>dy/dt = x,   starting from 0</span></pre>"));
  EXPECT_THAT(page, HasSubstr("<td>x.in</td><td>x/10</td><td class=\"n\">2</td><td>weight of y</td>"));
  EXPECT_THAT(page, HasSubstr("<td>x.initial</td><td>x/10</td><td class=\"n\">0.5</td>"));
  EXPECT_THAT(page, HasSubstr("50 %</td><td>x = 10 V</td>"));  // the largest x, of the machine unit
  EXPECT_THAT(page,
              HasSubstr("<td>x</td><td class=\"n\">5</td><td class=\"n\">0</td>"));  // static test, in V
  EXPECT_THAT(page, HasSubstr("<td>x minimum</td><td class=\"n\">-5</td>"));
  for (const char* const section :
       {"Where it comes from", "The circuit", "What it solves", "Curves", "Against an independent solution",
        "Scaling", "Settings", "Static test", "Stability", "Machines"})
    EXPECT_THAT(page, HasSubstr(std::string(">") + section + "</h2>"));
  EXPECT_THAT(page, Not(HasSubstr("Published and computed")));
  for (const char* const outside : {"<script", "src=", "url(", "href=\"http"})
    EXPECT_THAT(page, Not(HasSubstr(outside)));
}

TEST(DiagramReport, RepeatsNothingThatSaysNothing) {
  const std::string page = page_of(R"toml(format = "oblique-diagram/1"
[run]
until = 1
[blocks]
speed = { type = "integrator", in = ["-2*speed"], initial = 0.5, label = "speed" }
half = { type = "summer", in = ["0.5*speed"], label = "ẋ" }
[outputs]
speed = { signal = "speed", scale = 10, unit = "1" }
half = "half"
)toml");
  EXPECT_THAT(page, HasSubstr("d(speed)/dt = −2·speed"));
  EXPECT_THAT(page, HasSubstr("<td>speed</td><td></td><td>Integrator</td>"));  // its label is its name
  EXPECT_THAT(page, HasSubstr("<td>half</td><td>ẋ</td>"));
  EXPECT_THAT(page, HasSubstr("50 %</td><td>speed = 10</td>"));  // of no unit
  EXPECT_THAT(page, HasSubstr("25 %</td><td></td>"));            // 1 machine unit is 1 machine unit
}

TEST(DiagramReport, TestsWhatStandsOnThePanel) {
  const std::string page = page_of(R"toml(format = "oblique-diagram/1"
[run]
until = 1
[blocks]
crank = { type = "crank-generator", rate = 1 }
across = { type = "summer", in = ["0.5*crank.sin", "0.25*crank.cos"] }
parts = { type = "resolver", length = "across", angle = "across" }
[outputs]
across = "across"
)toml");
  const std::string test = page.substr(page.find(">Static test</h2>"));
  EXPECT_THAT(test, HasSubstr("<td>across</td><td class=\"n\">0.25</td>"));
  EXPECT_THAT(test, HasSubstr("<td>parts.x</td><td class=\"n\">0.2422</td>"));  // 0.25 cos 0.25
  EXPECT_THAT(test, Not(HasSubstr("<td>crank.")));                              // the inside of a composite
}

// Values in volts of a machine whose amplifiers have a bandwidth: the equations are those of ideal ones, and
// the static test what one computes by hand, x = 5 V, v′ = 0.3·5 V + 2 V.
TEST(DiagramReport, TakesValuesInVoltsAsThoseOfIdealElements) {
  const std::string page = page_of(R"toml(format = "oblique-diagram/1"
[machine]
profile = "tr-10"
[run]
until = 1
[blocks]
x = { type = "integrator", in = ["v"], initial = "5 V" }
v = { type = "integrator", in = ["-0.3*x", "-0.1*v", "c"] }
c = { type = "constant", value = "-2 V" }
)toml");
  EXPECT_THAT(page, HasSubstr("<span>dx/dt = −v,   starting from 0.5</span>"
                              "<span>dv/dt = 0.3·x + 0.1·v + 0.2,   starting from 0</span>"));
  const std::string test = page.substr(page.find(">Static test</h2>"));
  EXPECT_THAT(test, HasSubstr("<td>x</td><td class=\"n\">5</td><td class=\"n\">0</td>"));
  EXPECT_THAT(test, HasSubstr("<td>v</td><td class=\"n\">0</td><td class=\"n\">3.5</td>"));
  EXPECT_THAT(page, Not(HasSubstr("Where it comes from")));  // nothing is known of that
}

TEST(DiagramReport, SaysWhatAnAmplifierSolvesFor) {
  EXPECT_THAT(page_of("format = \"oblique-diagram/1\"\n[run]\nuntil = 1\n[blocks]\n"
                      "x = { type = \"constant\", value = 0.5 }\n"
                      "y = { type = \"servo-amplifier\", gain = 10, limit = 1, in = [\"-0.1*x\", \"y\"] }\n"
                      "[outputs]\ny = \"y\"\n"),
              HasSubstr("<span>0 = y − 0.05,   solved for y</span>"));
}

// No machine has steps and sines as elements: the verdict is on what they are made of.
TEST(DiagramReport, TellsWhichMachinesTakeIt) {
  const std::string page = page_of(R"toml(format = "oblique-diagram/1"
[run]
until = 1
[blocks]
u = { type = "step", at = 0.5, to = 5000 }
x = { type = "integrator", in = ["u", "-x"] }
z = { type = "sine", in = "0.001*x" }
[outputs]
z = "z"
)toml");
  EXPECT_THAT(page, HasSubstr("<td>EAI PACE TR-10 (1959)</td><td>it fits</td>"));
  EXPECT_THAT(page,
              HasSubstr("<td>Comdyna GP-6</td><td>it does not fit; missing: function generators (1)</td>"));
  EXPECT_THAT(page, HasSubstr("overloads a real machine, unless it is scaled for one."));
  EXPECT_THAT(page, HasSubstr("<td>5000 times</td>"));
  EXPECT_THAT(page, HasSubstr("<td class=\"n\">1</td>"));  // the sine, on its way to 1.967 rad
}

// What a function generator is set to stands below the equations, by the name that these give it.
TEST(DiagramReport, ListsThePointsOfFunctions) {
  const std::string page = page_of(R"toml(format = "oblique-diagram/1"
[run]
until = 1
[blocks]
x = { type = "integrator", in = ["f"], initial = 0.5 }
f = { type = "function-generator", in = "x", points = [[-1, 0.75], [0, 0], [1, -0.25]] }
)toml");
  EXPECT_THAT(page, HasSubstr("dx/dt = table1(x)"));
  EXPECT_THAT(page, HasSubstr("<td>table1</td><td>(−1, 0.75), (0, 0), (1, −0.25)</td>"));
}

TEST(DiagramReport, HoldsWhatWasPublished) {
  const std::string page = page_of(kReported + kReportedAsPublished, "index.html", "studio.html#abc");
  EXPECT_THAT(page, AllOf(HasSubstr("<p>A. Author, Rings, 1960.</p>"),
                          HasSubstr("href=\"https://example.org/rings\""),
                          HasSubstr("The circuit as it was patched, on: TR-10 no. 7."),
                          HasSubstr("<li>The sign is missing.</li>"), HasSubstr("As on the plotter:"),
                          HasSubstr("<td>x maximum</td><td class=\"n\">4.5</td><td class=\"n\">0.1</td>"),
                          HasSubstr("x maximum differs: the ink was thick."),
                          HasSubstr("<a href=\"index.html\">"), HasSubstr("<a href=\"studio.html#abc\">")));
  EXPECT_THAT(page_of(kReported + "[published]\nauthor = \"A\"\ntitle = \"T\"\nkind = \"equations\"\n"),
              AllOf(HasSubstr("Composed here: no circuit, or no result of a machine, was published."),
                    HasSubstr("No value was published to hold the run against.")));
}

// y against x is a circle of 5 V here: the axes have one scale.
TEST(DiagramReport, DrawsAsThePlotterDid) {
  const Programme programme =
      run_programme("ring.toml", kReported + kReportedAsPublished, testing::shipped_blocks());
  const draw::Chart chart = plotter_chart(programme, testing::shipped_blocks());
  ASSERT_EQ(chart.panels.size(), 1U);
  EXPECT_EQ(chart.panels[0].x.name, "x");
  EXPECT_EQ(chart.panels[0].y.name, "y");
  EXPECT_TRUE(chart.panels[0].equal);
  for (const auto& point : chart.panels[0].curves.at(0).points) EXPECT_NEAR(point.norm(), 5, 0.01);
}

}  // namespace
}  // namespace oblique::report
