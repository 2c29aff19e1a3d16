// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/compare/compare.h>
#include <oblique/draw/chart/chart.h>

#include <oblique/report/monte_carlo_report.h>

namespace oblique::report {

/// The largest error over the gain with the fitted slopes, where there is more than one gain, and for each
/// method and bandwidth the error along the way at each gain.
draw::Chart chart_of(const compare::Comparison& comparison);

/// The largest error of one series over the gain with its parts (`ErrorParts`, their magnitudes), a line of
/// order −1 through what stands clear of the tolerance, and what the tolerance leaves. Runs that left their
/// branch stand apart; parts far below what the tolerance leaves tell nothing and are left out. For gains
/// that come one after the other: one run is enough.
draw::Chart parts_chart(const compare::Comparison& comparison);

/// What the runs of Monte Carlo tell: their errors along the way, as the bands of half and of 95 % of them
/// about the median, and how often they err how much, with the errors that half and 95 % of them do not
/// exceed.
std::vector<draw::Panel> panels_of(const compare::Comparison& comparison, const MonteCarloReport& report);

}  // namespace oblique::report
