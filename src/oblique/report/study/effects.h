// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/report/study/study_text.h>

namespace oblique::report {

/// What a varied name does to a measure while the others go through all their values.
struct Effect {
  std::size_t name = 0;  ///< among the varied ones
  /// Of a grid: the least and the greatest mean of the measure over the machines of one value of the name,
  /// and these values. Otherwise `low` is the rank correlation after Spearman, from −1 to 1, or 0 below it.
  double low = 0, high = 0;
  double low_at = 0, high_at = 0;

  double size() const { return high - low; }
};

/// Those of all varied names, the greatest first; machines without a value are left out.
std::vector<Effect> effects_of(const StudyResult& result, std::size_t measure);

/// The mean of a measure over all machines that have a value.
double mean_of(const StudyResult& result, std::size_t measure);

/// A table of them for each measure.
std::string effects_text(const StudyResult& result);

}  // namespace oblique::report
