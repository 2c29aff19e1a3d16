// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/integrator/interpolant.h>

namespace oblique::solve {

/// Sees to it that no step hides what the time alone does, or a clock (an integrator of a constant), or what
/// a function makes of the states that is next to nothing here and a peak there, or leads an event function
/// over zero and back.
///
/// A pulse may lie between two times at which a solver looks, and a fast sine may look slow. Whether it does
/// is not guessed: interval arithmetic bounds every source over the whole of a step, and those of the time
/// their derivatives. A step is parted until over each part every source is monotone, or within what its ends
/// show; the event function of a switch that follows the time alone, until it is monotone or has no zero; one
/// that bends and reads states, until it has no zero or passes it once, as far as bounds can tell. The
/// states are bounded by the cubic through their values and rates at the ends of a part, and twice its bend.
/// What a function makes of differences of states, which hardly change where each of the states does, has no
/// bounds that tell, nor has a source that is zero because its terms cancel: of such parts there are some to
/// spend, and a few more at every step.
class SourceWatch {
 public:
  /// What of the sources is shown: their extremes, or whether they leave ±1 machine unit.
  enum class Shown { nothing, overloads, extremes };

  /// Looks at the sources that act on the states and switches, and at those too that are only `shown`; of all
  /// of these no extreme that matters there is hidden. Program, workspace and file must outlive this.
  SourceWatch(const network::Program& program, const network::Workspace& workspace, Shown shown,
              const std::string& file);

  /// How often it may look at most in the whole run.
  void limit_samples(double samples) { samples_left_ = samples; }

  bool active() const { return !watched_.empty(); }

  /// Times in (from, to], ascending, the last one `to`, at which to look. `to` alone where nothing is hidden.
  /// Throws SolveError where there are more than it may look at. Which comparisons others mask the discrete
  /// states tell, but during a slide.
  const std::vector<double>& sample_times(double from, double to, const Interpolant& solution, bool slides);

  /// Whether a comparison acts now that others masked when it was last asked.
  bool acts_anew() const;

 private:
  /// At one time: the sources, and the source states with their rates.
  struct Values {
    std::vector<double> sources, states, rates;
  };
  /// What a part of a step may hide; a peak of the time is one of a source that is nothing at both of its
  /// ends.
  enum class Hidden { nothing, peak_of_states, peak_of_time, other };
  /// So many parts where bounds may never tell: of a step at most, of the first steps together, and what
  /// each later step adds.
  struct Allowance {
    int most, saved, earned;
    int most_saved = saved, at_begin = 0, left = 0;  ///< in the run; in this step, in this part of it

    void begin_step() { left = at_begin = std::min(saved, most); }
    void end_step() { saved = std::min(saved - (at_begin - left) + earned, most_saved); }
  };
  Hidden hidden(double from, const Values& at_from, double to, const Values& at_to, int depth);
  void part(double from, const Values& at_from, double to, const Values& at_to, int depth);
  bool may_turn(const network::Source& source, double a, double b, const network::Interval& range, int depth);
  bool is_nothing(std::size_t k, double a, double b) const;
  bool hides_extreme(std::size_t k, double a, double b, const network::Interval& range) const;
  Values values_at(double t);
  void bound(double from, const Values& at_from, double to, const Values& at_to);

  const network::Program& program_;
  const network::Workspace& workspace_;
  const std::string& file_;
  Shown shown_;
  double samples_left_ = 1e9;
  std::vector<network::Source> watched_;
  std::vector<network::Interval> slots_;
  const Interpolant* solution_ = nullptr;
  std::vector<double> states_, rates_;     ///< all of them, at a time
  std::vector<network::Interval> ranges_;  ///< of the source states
  std::vector<double> largest_;            ///< magnitude of each source so far
  std::vector<double> widest_;             ///< range of each source over a part so far
  std::vector<network::Interval> seen_;    ///< values of each source so far
  std::vector<bool> masked_;               ///< each source, when it was last asked
  std::vector<double> times_;
  int parts_for_states_ = 0;       ///< of this step, in which an event function of states had to be looked at
  Allowance of_states_, of_time_;  ///< parts for peaks of the one and the other
};

}  // namespace oblique::solve
