// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/draw/chart/chart.h>
#include <oblique/solve/run.h>

namespace oblique::report {

/// What of a run is drawn.
struct RunChartRequest {
  std::vector<std::string> columns;  ///< empty: all
  std::string against;               ///< the column along the other axis; empty: `t`
};

/// The columns that a request draws, by their numbers, without the one that they are drawn against; where it
/// names none, no more than can be told apart.
struct DrawnColumns {
  std::size_t against = 0;
  std::vector<std::size_t> drawn;
  std::size_t left_out = 0;
};

/// Throws ReadError for a name that is no column, for too many, and where nothing is left to draw.
DrawnColumns drawn_columns(const std::vector<text::TableColumn>& columns, const RunChartRequest& request);

/// Asks a run for as many further rows as make its curves smooth, where its own would be too few.
void ask_for_curves(solve::RunOptions& options, std::size_t n_columns);

/// What is 0 to rounding in each column of `output_columns`, in its unit: less than a few units in the last
/// place of 1 machine unit, or than the absolute tolerance where that is finer.
std::vector<double> rounding_of(const diagram::FlatDiagram& diagram, const solve::RunOptions& options);

/// A panel for each unit, one above the other; a column that never exceeds its `rounding` is drawn as 0.
/// Drawn against another column than the time one panel has equal scales where both axes have one unit.
draw::Chart chart_of(const solve::Run& run, const std::vector<double>& rounding, const DrawnColumns& columns,
                     const std::string& title);

}  // namespace oblique::report
