// SPDX-License-Identifier: MIT
#include <oblique/report/run_chart.h>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/text/document.h>

#include "../support/compiled.h"

namespace oblique::report {
namespace {

using testing::message_of;

/// `t` and so many columns c1, c2 ….
std::vector<text::TableColumn> columns(std::size_t n) {
  std::vector<text::TableColumn> made{{"t", "s"}};
  for (std::size_t c = 1; c <= n; ++c) made.push_back({fmt::format("c{}", c)});
  return made;
}

RunChartRequest first(std::size_t n) {
  RunChartRequest request;
  for (std::size_t c = 1; c <= n; ++c) request.columns.push_back(fmt::format("c{}", c));
  return request;
}

TEST(DrawnColumns, AreAsManyAsCanBeToldApart) {
  const auto all = columns(draw::kMostCurves + 3);
  EXPECT_EQ(drawn_columns(all, first(draw::kMostCurves)).drawn.size(), draw::kMostCurves);
  EXPECT_EQ(message_of<text::ReadError>([&] { drawn_columns(all, first(draw::kMostCurves + 1)); }),
            fmt::format("'columns': {} curves cannot be told apart; expected at most {}",
                        draw::kMostCurves + 1, draw::kMostCurves));
  const DrawnColumns unasked = drawn_columns(all, {});
  EXPECT_EQ(unasked.drawn.size(), draw::kMostCurves);
  EXPECT_EQ(unasked.left_out, 3U);
  EXPECT_EQ(drawn_columns(columns(draw::kMostCurves), {}).left_out, 0U);
}

}  // namespace
}  // namespace oblique::report
