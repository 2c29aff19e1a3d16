// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/compare/compare.h>
#include <oblique/draw/chart.h>

#include "monte_carlo_output.h"

namespace oblique::cli {

/// The largest error over the gain with the fitted slopes, where there is more than one gain, and the error
/// along the way of each run.
Chart chart_of(const Comparison& comparison);

/// How often runs of Monte Carlo err how much, with the percentiles that half and 95 % of them do not exceed.
Panel panel_of(const MonteCarloReport& report);

}  // namespace oblique::cli
