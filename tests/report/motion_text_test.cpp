// SPDX-License-Identifier: MIT
#include <oblique/report/motion_text.h>

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/mechanism/model/coefficients.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::report {
namespace {

using mechanism::MotionEvent;
using mechanism::Status;
using ::testing::ElementsAre;

mechanism::Mechanism four_bar() {
  return mechanism::read_mechanism(OBLIQUE_SOURCE_DIR "/diagrams/mechanisms/four-bar.toml");
}

TEST(MotionText, NamesTheColumnsOfATableWithTheirUnits) {
  const auto mechanism = four_bar();
  const auto columns = motion_table_columns(mechanism);
  ASSERT_EQ(columns.size(), mechanism::motion_column_names(mechanism).size() + 1);
  EXPECT_EQ(columns.front().name, "t");
  EXPECT_EQ(columns.front().unit, "s");
  EXPECT_EQ(columns.back().name, "status");
  EXPECT_THAT(columns.back().labels, ElementsAre("ok", "dead-centre", "open"));
}

TEST(MotionText, ShowsCoordinatesOfRowsFromFirstToLast) {
  const auto mechanism = four_bar();
  const std::size_t width = mechanism::motion_column_names(mechanism).size();
  MotionDigest digest(27);
  for (int row = 0; row < 27; ++row)
    digest.add(std::vector<double>(width, row), row == 26 ? Status::open : Status::ok);
  const auto rows = digest.table(mechanism, 5).rows();
  ASSERT_EQ(rows.size(), 2U + digest.shown());
  EXPECT_EQ(digest.shown(), 13U);
  EXPECT_EQ(rows[0].size(), 5U);
  EXPECT_EQ(rows[0].front(), "t");
  EXPECT_EQ(rows[0].back(), "status");
  for (std::size_t c = 1 + mechanism.drives.size(); c + 1 < rows[0].size(); ++c)
    EXPECT_TRUE(rows[0][c].ends_with(".x") || rows[0][c].ends_with(".y")) << rows[0][c];
  EXPECT_EQ(rows[2].front(), "0");
  EXPECT_EQ(rows[3].front(), "2");  // 27 rows in 13: every other, up to rounding down
  EXPECT_EQ(rows.back().front(), "26");
  EXPECT_EQ(rows.back().back(), "open");
}

TEST(MotionText, CountsWhatHasNoPoseAndNoVelocity) {
  MotionDigest digest(4);
  const std::vector<double> values(3);
  digest.add(values, Status::ok);
  EXPECT_EQ(digest.remarks(), "");
  digest.add(values, Status::dead_centre);
  digest.add(values, Status::open);
  digest.add(values, Status::open);
  EXPECT_EQ(digest.open(), 2U);
  const text::Vocabulary options{[](const text::Setting& s) { return "--" + s.name + " " + s.value; }, {}};
  EXPECT_EQ(digest.remarks(options),
            "1 positions are dead centres: velocities have no value there\n"
            "2 of 4 positions cannot be assembled; --at-limit stop or reverse keeps the motion within its "
            "range\n");
}

TEST(MotionText, SaysWhereTheDriveStandsAtEachEvent) {
  const auto mechanism = four_bar();
  const auto structure = mechanism::decompose(mechanism);
  const std::string group = structure.groups.front().name;
  const std::string drive = mechanism.drives.front().name;
  const double start = mechanism::DriveClock(mechanism).at(0, 0).value * 180 / 3.14159265358979323846;
  ASSERT_EQ(start, 0);
  EXPECT_EQ(
      events_text(mechanism, structure, {{MotionEvent::Kind::limit, 0.0, 0}}),
      "limit at " + drive + " = 0 deg: a dead centre of " + group + ", which cannot be assembled beyond\n");
  EXPECT_EQ(events_text(mechanism, structure, {{MotionEvent::Kind::lost, 0.0, 0}}),
            "lost at " + drive + " = 0 deg: no step leads " + group +
                " on, and that this is a limit is not proven\n");
  EXPECT_TRUE((MotionEvent{MotionEvent::Kind::lost}.ends()));
  const std::vector<MotionEvent> many(10, {MotionEvent::Kind::change, 0.0, 0});
  const std::string text = events_text(mechanism, structure, many);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 9);
  EXPECT_TRUE(text.ends_with("(2 more)\n"));
}

}  // namespace
}  // namespace oblique::report
