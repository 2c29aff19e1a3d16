// SPDX-License-Identifier: MIT
// Texts of charts stand apart, within the picture and beside the curves: in everything that is shipped.
#include <algorithm>

#include <oblique/mechanism/model/read_mechanism.h>

#include "plot_reading.h"

namespace oblique::test {
namespace {

class PlotTexts : public PlotTest {};

void expect_texts_apart(const Svg& svg, int panels) {
  const auto labels = svg.labels();
  const AlignedBox2d paper(Vector2d(0, 0), svg.size());
  for (std::size_t a = 0; a < labels.size(); ++a) {
    const AlignedBox2d extent = draw::extent_of(draw::Mark{labels[a]});
    EXPECT_TRUE(paper.contains(extent)) << labels[a].text;
    for (int p = 0; p < panels; ++p) EXPECT_FALSE(svg.plot(p).intersects(extent)) << labels[a].text;
    for (std::size_t b = 0; b < a; ++b)
      EXPECT_FALSE(extent.intersects(draw::extent_of(draw::Mark{labels[b]})))
          << labels[a].text << " and " << labels[b].text;
  }
}

std::vector<std::string> shipped(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/" + folder))
    files.push_back("diagrams/" + folder + "/" + entry.path().filename().string());
  std::sort(files.begin(), files.end());
  return files;
}

TEST_F(PlotTexts, TextsOfComparisonsCoverNothing) {
  for (const char* arguments :
       {"compare diagrams/mechanisms/four-bar.toml --method triangles,gradient",
        "compare diagrams/mechanisms/slider-crank.toml --monte-carlo 20 --tolerance 1%",
        "check diagrams/lessons/damped-oscillator.toml"}) {
    SCOPED_TRACE(arguments);
    const Svg svg = drawn(arguments);
    EXPECT_GT(svg.labels().size(), 5U);
    expect_texts_apart(svg, 1);
  }
}

TEST_F(PlotTexts, TextsOfEveryShippedDiagramsRunCoverNothing) {
  for (const char* folder : {"lessons", "historical"}) {
    for (const std::string& diagram : shipped(folder)) {
      SCOPED_TRACE(diagram);
      const Svg svg = drawn("run " + diagram);
      EXPECT_GT(svg.labels().size(), 5U);
      expect_texts_apart(svg, svg.panels());
    }
  }
}

TEST_F(PlotTexts, TextsOfEveryShippedMechanismsPointPlotsCoverNothing) {
  for (const std::string& name : shipped("mechanisms")) {
    SCOPED_TRACE(name);
    const mechanism::Mechanism mechanism =
        mechanism::read_mechanism(std::string(OBLIQUE_SOURCE_DIR) + "/" + name);
    if (mechanism.drives.empty()) continue;
    const auto moving = std::find_if(mechanism.points.rbegin(), mechanism.points.rend(),
                                     [](const mechanism::Point& point) { return !point.fixed; });
    const Outcome outcome = oblique("draw " + name + " --plots " + moving->name + " -o " + file("plots.svg"));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const Svg svg(bytes_of("plots.svg"));
    EXPECT_EQ(svg.panels(), 6);
    expect_texts_apart(svg, 6);
  }
}

}  // namespace
}  // namespace oblique::test
