// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <oblique/ensemble/study/row_expression.h>
#include <oblique/ensemble/study/sampled_run.h>

// Of this stage; not installed.
namespace oblique::ensemble {

/// How far a mechanism's diagram is from its exact motion, over all moving points and rows [length unit].
struct MotionErrors {
  double largest = 0, rms = 0;
};

/// A measure, made ready to be taken of many runs.
///
/// It is an expression of functions of the run (`max(x)`, `end(x)` …), whose arguments are expressions of the
/// run's columns. `max` and `min` of several arguments are those of the numbers.
class MeasureProgram {
 public:
  /// Gives the number of the column that a name means ("side", "c.out"; of a mechanism also "exact(B.x)");
  /// throws ExpressionError where it means none. Of the time it is not asked: that is column 0.
  using ColumnOf = std::function<std::size_t(const std::string& name)>;

  /// `mechanism`: there is an exact motion. An argument that is the name of one of the `outputs` is that
  /// output, be it as it may ("x-v"). Throws ExpressionError with the column in the text.
  MeasureProgram(std::string_view text, bool mechanism, std::span<const std::string> outputs,
                 const ColumnOf& column_of);

  bool asks_for_errors() const;
  bool is_distance() const { return is_distance_; }  ///< nothing but `error()` or `rms_error()`
  double value(const SampledRun& run, const MotionErrors& errors) const;

 private:
  enum class Function { max, min, mean, rms, end, start, integral, time, error, rms_error };
  struct RunNumber {
    Function function = Function::end;
    RowExpression argument;
    std::vector<RowExpression> sides;  ///< of the comparisons of a `time`
  };

  class Reader;
  static double value_of(const RunNumber& number, const SampledRun& run, const MotionErrors& errors);

  std::vector<RunNumber> numbers_;
  RowExpression combination_;  ///< of them
  bool is_distance_ = false;
};

}  // namespace oblique::ensemble
