// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <oblique/diagram/rescale.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/integrator/interpolant.h>
#include <oblique/solve/run_records.h>

namespace oblique::solve {

class Switching;

/// Watches every signal of a run against the machine unit, as the overload lamps of a real machine do. Each
/// step is looked at in its ends and its middle. Where the parabola through the three has an extreme between
/// them that matters, it is sought on the solver's interpolant; below 0.99 machine units the parabola's own
/// value is taken. Times are those at which the magnitude passes 1, to the rounding of the interpolant.
class OverloadWatch {
 public:
  /// `switching` is that of the run. Where `halt` is set, `advance` stops at the first overload.
  OverloadWatch(const network::Program& program, Switching& switching, std::string file, bool halt);

  /// Begins at (t, states), or goes on there after a jump of the signals. Throws SolveError.
  void restart(double t, std::span<const double> states);

  /// Looks at the step from the last time to t; gives the time to which the run counts: t, or that of the
  /// first overload where it halts there. At an instant at which an algebraic loop is singular, as a run
  /// passes some without meeting them, a moment close by is taken. Throws SolveError where a loop has no
  /// solution there either.
  double advance(double t, const Interpolant& solution);

  bool halted() const { return halted_; }

  /// The peaks of all signals so far, in the order of the program.
  std::vector<Peak> peaks() const;
  /// The overloads so far, the first one first.
  std::vector<OverloadRecord> overloads() const;

 private:
  struct Record {
    Peak peak;
    std::optional<double> outside_since;  ///< [s] of the excursion that goes on
    bool counts = false;                  ///< the excursion exceeds the tolerance
    std::optional<double> first;
    double duration = 0;
  };
  struct Sample {
    double time, value;
  };

  void evaluate(double t, std::vector<double>& values);
  void evaluate_near(double t, double end, const Interpolant& solution, std::vector<double>& values);
  double value_at(double t, double end, std::size_t signal, const Interpolant& solution);
  void look_at(std::size_t signal, double t, const Interpolant& solution);
  bool matters(const Record& record, double extreme, double before, double after) const;
  Sample find_extreme(std::size_t signal, double near, double end, const Interpolant& solution);
  double find_crossing(std::size_t signal, Sample inside, Sample outside, double end,
                       const Interpolant& solution);
  void leave(Record& record, double t, double value);
  void come_back(Record& record, double t);

  const network::Program& program_;
  const network::Workspace& workspace_;
  Switching& switching_;
  std::string file_;
  bool halt_;
  bool halted_ = false;
  double t_ = 0;
  std::vector<Record> records_;
  std::vector<double> states_, probe_;
  std::vector<double> begin_, middle_, end_;  ///< signals in the three places of a step
};

}  // namespace oblique::solve
