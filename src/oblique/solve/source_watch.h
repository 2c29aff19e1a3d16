// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <oblique/network/program.h>

namespace oblique {

/// Sees to it that no step hides what the time alone does.
///
/// A pulse of the time may lie between two times at which a solver looks, and a fast sine may look slow.
/// Whether it does is not guessed: interval arithmetic bounds every source and its slope over the whole of a
/// step. A step is parted until over each part every source is monotone, or within what its ends show; the
/// surface of a switch that follows the time alone, until it is monotone or has no zero.
class SourceWatch {
 public:
  /// Looks at the sources that act on the states and switches, and with `outputs` at those too that are only
  /// shown. Both must outlive this.
  SourceWatch(const Program& program, const Workspace& workspace, bool outputs);

  bool active() const { return !watched_.empty(); }

  /// Times in (from, to], ascending, the last one `to`, at which to look. `to` alone where nothing is hidden.
  const std::vector<double>& looks(double from, double to);

 private:
  using Values = std::vector<double>;
  void part(double from, const Values& at_from, double to, const Values& at_to, int depth);
  bool is_plain(double from, const Values& at_from, double to, const Values& at_to);
  Values values_at(double t);

  const Program& program_;
  const Workspace& workspace_;
  std::vector<Source> watched_;
  std::vector<Interval> slots_;
  std::vector<double> largest_;  ///< magnitude of each source so far
  std::vector<double> times_;
};

}  // namespace oblique
