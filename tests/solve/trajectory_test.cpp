// SPDX-License-Identifier: MIT
#include <oblique/solve/trajectory.h>

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace oblique {
namespace {

TEST(Trajectory, IsATableByRowAndColumn) {
  Trajectory table({{"t", "s"}, {"x", "m"}});
  EXPECT_EQ(table.rows(), 0U);
  table.add_row(std::array{0.0, 1.5});
  table.add_row(std::array{0.5, -2.0});
  EXPECT_EQ(table.rows(), 2U);
  EXPECT_EQ(table.at(1, 1), -2);
  EXPECT_EQ(table.row(1)[0], 0.5);
  EXPECT_EQ(table.row(0).size(), 2U);
  EXPECT_EQ(table.find("x"), 1U);
  EXPECT_EQ(table.find("y"), std::nullopt);
}

TEST(Trajectory, IsEmptyWithoutColumns) {
  EXPECT_EQ(Trajectory().rows(), 0U);
  EXPECT_EQ(Trajectory().find("t"), std::nullopt);
}

TEST(Csv, HasALineOfNamesAndALineARow) {
  Trajectory table({{"t", "s"}, {"C.x", "mm"}});
  table.add_row(std::array{0.0, 1.5});
  table.add_row(std::array{0.1, -2e-300});
  EXPECT_EQ(to_csv(table), "t,C.x\n0,1.5\n0.1,-2e-300\n");
}

TEST(Csv, QuotesNamesAsRfc4180Says) {
  EXPECT_EQ(to_csv(Trajectory({{"a,b", ""}, {"say \"x\"", ""}, {"two\nlines", ""}, {"plain name", ""}})),
            "\"a,b\",\"say \"\"x\"\"\",\"two\nlines\",plain name\n");
}

/// Any double that has a value, by its bits.
rc::Gen<double> finite_double() {
  return rc::gen::suchThat(rc::gen::map(rc::gen::arbitrary<std::uint64_t>(),
                                        [](std::uint64_t bits) { return std::bit_cast<double>(bits); }),
                           [](double value) { return std::isfinite(value); });
}

RC_GTEST_PROP(Csv, ReadsBackUnchanged, ()) {
  const auto values = *rc::gen::container<std::vector<double>>(6, finite_double());
  Trajectory table({{"t", "s"}, {"x", ""}, {"y", ""}});
  table.add_row(std::span(values).first(3));
  table.add_row(std::span(values).last(3));
  std::istringstream text(to_csv(table));
  std::string line;
  std::getline(text, line);
  std::vector<double> read;
  while (std::getline(text, line)) {
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) {
      double value = 0;
      const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
      RC_ASSERT((error == std::errc() && end == field.data() + field.size()));
      read.push_back(value);
    }
  }
  RC_ASSERT(read == values);
}

}  // namespace
}  // namespace oblique
