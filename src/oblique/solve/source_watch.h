// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/network/program.h>
#include <oblique/solve/interpolant.h>

namespace oblique {

/// Sees to it that no step hides what the time alone does, or a clock (an integrator of a constant).
///
/// A pulse of the time may lie between two times at which a solver looks, and a fast sine may look slow.
/// Whether it does is not guessed: interval arithmetic bounds every source and its slope over the whole of a
/// step. A step is parted until over each part every source is monotone, or within what its ends show; the
/// surface of a switch that follows the time alone, until it is monotone or has no zero.
class SourceWatch {
 public:
  /// Looks at the sources that act on the states and switches, and with `outputs` at those too that are only
  /// shown. Both must outlive this.
  SourceWatch(const Program& program, const Workspace& workspace, bool outputs, const std::string& file);

  /// How often it may look at most in the whole run.
  void limit_looks(double looks) { looks_left_ = looks; }

  bool active() const { return !watched_.empty(); }

  /// Times in (from, to], ascending, the last one `to`, at which to look. `to` alone where nothing is hidden.
  /// Throws SolveError where there are more than it may look at.
  const std::vector<double>& looks(double from, double to, const Interpolant& solution);

 private:
  using Values = std::vector<double>;
  void part(double from, const Values& at_from, double to, const Values& at_to, int depth);
  bool is_plain(double from, const Values& at_from, double to, const Values& at_to);
  Values values_at(double t);
  void bound(double from, double to);

  const Program& program_;
  const Workspace& workspace_;
  const std::string& file_;
  double looks_left_ = 1e9;
  std::vector<Source> watched_;
  std::vector<Interval> slots_;
  double step_begin_ = 0, step_end_ = 0;            ///< [s]
  std::vector<double> states_, at_begin_, at_end_;  ///< all states; the clocks at both ends of the step
  std::vector<Interval> clocks_;
  std::vector<double> largest_;  ///< magnitude of each source so far
  std::vector<double> times_;
};

}  // namespace oblique
