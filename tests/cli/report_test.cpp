// SPDX-License-Identifier: MIT
// The page of `report`.
#include <cmath>
#include <sstream>

#include <nlohmann/json.hpp>

#include <oblique/mechanism/structure/structure.h>
#include "plots/plot_reading.h"

namespace oblique::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class Report : public PlotTest {};

TEST_F(Report, TheReportIsOnePageWithAllOfIt) {
  const std::string four_bar = "diagrams/mechanisms/four-bar.toml";
  const Outcome outcome = oblique("report " + four_bar + " --machine tr-10 -o " + file("page.html"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string page = bytes_of("page.html");
  for (const char* part : {"<!DOCTYPE html>",
                           ">The mechanism</h2>",
                           ">Structure</h2>",
                           "C lies left of B → D",
                           ">Motion</h2>",
                           ">Patch</h2>",
                           "Coordinates: 1 machine unit = ",
                           "its servo loops come to rest everywhere",
                           "dyad-rrr</text>",
                           ">Convergence</h2>",
                           "falls with the gain to the power",
                           ">Stability</h2>",
                           "servo loops, least damped",
                           "servo loops, slowest",
                           "the problem itself, least damped",
                           ">On the EAI",
                           ">It does not fit; missing: ",
                           ">Sheet: ",
                           "@media print",
                           "prefers-color-scheme: dark",
                           "</html>"})
    EXPECT_THAT(page, HasSubstr(part));
  for (const char* outside : {"<script", "src=", "url(", "id=\"curve"})
    EXPECT_THAT(page, Not(HasSubstr(outside)));
  // the contents lead to every section, and nowhere else
  std::size_t links = 0;
  for (std::size_t at = page.find("href="); at != std::string::npos; at = page.find("href=", at + 1)) {
    const std::string id = "section-" + std::to_string(++links);
    EXPECT_EQ(page.substr(at, id.size() + 8), "href=\"#" + id + "\"");
    EXPECT_THAT(page, HasSubstr("<h2 id=\"" + id + "\">"));
  }
  EXPECT_EQ(links, 7U);
  // the errors are those of `compare`
  const auto json = nlohmann::json::parse(oblique("compare " + four_bar + " --json").out);
  const double error = json["runs"][2]["max_error"];
  const double exponent = std::floor(std::log10(error));
  ASSERT_EQ(exponent, -5);
  std::ostringstream text;
  text.precision(4);
  text << error / std::pow(10, exponent) << "·10⁻⁵";
  EXPECT_THAT(page, HasSubstr(text.str()));
}

// Nothing of a parallelogram can be tracked where it is flat; all that is exact is told all the same.
TEST_F(Report, TheReportSaysWhyThereIsNoPatch) {
  const Outcome outcome = oblique("report diagrams/mechanisms/parallelogram.toml -o " + file("page.html"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string page = bytes_of("page.html");
  for (const char* part : {">Structure</h2>", ">Motion</h2>", "There is no patch of this mechanism.",
                           "dead centre", "Remedy: change a length a little"})
    EXPECT_THAT(page, HasSubstr(part));
  EXPECT_THAT(page, Not(HasSubstr(">Convergence</h2>")));
}

}  // namespace
}  // namespace oblique::test
