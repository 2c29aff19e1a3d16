// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <oblique/network/program/program.h>

namespace oblique::solve {

/// Values of equations on and beyond the edge of the branch on which the switches are latched, where they may
/// have none: max(x, 0)^1.5 a rounding below zero, if(s > 0, exp(-1/s), 0) where a step leads past s = 0 to
/// see the switch turn over. They are taken at the last place inside, on the way from where the solver stood
/// last; and where that itself lies on the edge, a hair inside. What ends elsewhere than where a switch
/// leaves its side stays no number. Not installed.
class EdgeValues {
 public:
  /// All must outlive this; `span` is the length of the run [s].
  EdgeValues(const network::Program& program, network::Workspace& workspace, double span)
      : program_(program), workspace_(workspace), span_(span) {}

  /// The solver stands at (t, x), or begins there.
  void stand_at(double t, std::span<const double> x) {
    if (program_.switches().empty()) return;
    stood_.t = t;
    stood_.x.assign(x.begin(), x.end());
    stands_ = true;
  }

  // Each fills in what the Program has left at (t, x) that is no finite number, with the discrete states as
  // they are in the workspace. True where there was any: the workspace then is evaluated elsewhere.
  bool complete_derivatives(double t, const double* x, std::span<double> dxdt);
  bool complete_signals(double t, const double* x, std::span<double> signals);
  /// In the place of a derivative by a state, which may be without bound on the edge, stands one inside:
  /// enough for Newton's method. None where the solver stands: it knows where else to take it.
  bool complete_jacobian(double t, const double* x, std::span<double> jacobian);

 private:
  struct Place {
    double t = 0;
    std::vector<double> x;
  };
  enum class Of { values, jacobian };
  using Evaluate = std::function<bool(const Place& at)>;
  /// What is to be filled in: which of the values, and what they are.
  struct Missing {
    std::vector<std::size_t> which;
    std::vector<double> values;
  };

  /// Of a switch on whose edge a place lies: how far its event function is inside, and the way on which it
  /// goes there.
  struct Way {
    std::size_t s;
    double side, time;
    std::vector<double> states;
  };

  bool misses_any(std::span<const double> values) const {
    return !program_.switches().empty() &&
           !std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  }
  template <class Function>
  bool complete(Of what, double t, const double* x, std::span<double> values, const Function& evaluate);
  bool find(Of what, const Place& at, std::span<const double> values, const Evaluate& evaluate,
            Missing& missing);
  bool find_on_way(Of what, const Place& from, const Place& to, std::span<const double> values,
                   const Evaluate& evaluate, Missing& missing);
  std::vector<Way> ways_inside(const Place& at);
  std::optional<Place> inside_of(Of what, const Place& at, std::span<const double> values,
                                 const Evaluate& evaluate, Missing& missing);
  std::vector<double> sides(const Place& at);
  std::vector<double> widths(const Place& at);

  const network::Program& program_;
  network::Workspace& workspace_;
  double span_;
  bool stands_ = false;
  Place stood_;  ///< where the solver stood last
};

}  // namespace oblique::solve
