// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "../support/runs.h"

namespace oblique::testing {

/// Expects a column of a run to be `form(t)` to `tolerance` at every row where `holds(t)`; rows at a jump,
/// where the value of either side is right, are for the caller to leave out.
template <class Form, class Holds>
void expect_form_where(const solve::Run& result, std::string_view column, double tolerance, Form form,
                       Holds holds) {
  const auto t = row_values(result, "t"), values = row_values(result, column);
  for (std::size_t r = 0; r < t.size(); ++r) {
    if (!holds(t[r])) continue;
    EXPECT_NEAR(values[r], form(t[r]), tolerance) << column << " at t = " << t[r];
  }
}

template <class Form>
void expect_form(const solve::Run& result, std::string_view column, double tolerance, Form form) {
  expect_form_where(result, column, tolerance, form, [](double) { return true; });
}

/// The last value of a column.
inline double last(const solve::Run& result, std::string_view column) {
  return row_values(result, column).back();
}

/// Integrators "cosine" and "sine": cos t and sin t.
inline constexpr const char* kCosineAndSine = R"toml(
cosine = { type = "integrator", in = ["-sine"], initial = 1 }
sine   = { type = "integrator", in = ["cosine"] }
)toml";

/// Rounding of times, derivatives and sums of a few numbers around 1, where nothing is integrated.
inline constexpr double kRounding = 1e-13;

/// Of a few thousand steps at the default relative tolerance of 1e-8.
inline constexpr double kIntegrated = 1e-6;

}  // namespace oblique::testing
