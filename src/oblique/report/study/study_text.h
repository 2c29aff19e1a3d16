// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <oblique/ensemble/study/study.h>

namespace oblique::report {

/// What came out of a study, for people and pictures.
struct StudyResult {
  std::string title;
  std::vector<text::TableColumn> columns;
  std::size_t n_varied = 0;
  std::vector<bool> logarithmic;  ///< of each varied name
  std::size_t drawn = 0;          ///< parameters that each machine draws
  bool grid = true;               ///< the varied values are those of a grid
  ensemble::Study::Rows done;

  std::size_t n_measures() const { return columns.size() - n_varied; }
  double measure(std::size_t row, std::size_t k) const { return done.rows[row].values[n_varied + k]; }
};

/// "c.gain = 100, c.bandwidth = 10 Hz", with the number of the machine where elements scatter.
std::string machine_text(const StudyResult& result, std::size_t row);

/// The first and the last rows, as many columns as fit.
std::string rows_text(const StudyResult& result, std::size_t columns_shown);

/// Of each measure the least, the median and the greatest value, and which machines have them.
std::string summary_text(const StudyResult& result);

/// How measures go with the names whose values are spaced logarithmically, on a grid without scatter: the
/// order p of "measure ~ name^p" between neighbours, its median and its range. Nothing of a measure that is 0
/// somewhere, changes its sign, or hardly depends on the name.
std::string order_text(const StudyResult& result);

/// How many machines ran in lanes and how many by CVODES, and why; how many failed, and the first of them.
std::string count_text(const StudyResult& result);

/// "note: …" of rows that are too few for measures, with the most they may err by; empty where they are not.
std::string coarse_text(const ensemble::EnsembleCount& count);

/// The value that this part [%] of the values, which ascend and of which there is at least one, do not
/// exceed: one of them, by the nearest rank.
double percentile_of(const std::vector<double>& ascending, double percent);

}  // namespace oblique::report
