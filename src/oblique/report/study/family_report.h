// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/draw/chart/chart.h>
#include <oblique/ensemble/study/family.h>
#include <oblique/report/run_chart.h>

namespace oblique::report {

/// `t`, then of each value of the family the outputs: "side (c.gain = 100)". Cells of a run that failed are
/// no numbers. Throws the failure where all failed.
solve::Trajectory table_of(const ensemble::Family& family, const std::vector<text::TableColumn>& columns);

/// The names of the columns of `table_of` that `names` choose: that of an output chooses its columns of all
/// values, any other is left as it is.
std::vector<std::string> names_in_table(const ensemble::Family& family,
                                        const std::vector<text::TableColumn>& columns,
                                        const std::vector<std::string>& names);

/// A panel for each drawn column, in which each value has its curve; of more values than can be told apart
/// some are left out, the first and the last not.
draw::Chart chart_of(const ensemble::Family& family, const std::vector<text::TableColumn>& columns,
                     const std::vector<double>& rounding, const DrawnColumns& drawn,
                     const std::string& title);

}  // namespace oblique::report
