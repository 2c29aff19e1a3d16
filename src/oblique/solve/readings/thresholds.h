// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include <oblique/network/program/program.h>

namespace oblique::solve {

/// How far the event function of each switch must have passed zero to have passed it: by more than rounding
/// and, where the switch has just turned over, by more than the errors of the states. Not installed.
class Thresholds {
 public:
  /// The program must outlive this.
  explicit Thresholds(const network::Program& program);

  /// Takes them from what was evaluated at time t.
  void update(double t, const network::Evaluation& here);

  double operator[](std::size_t s) const { return now_[s]; }

  /// Rounding of the event function of a switch at the last `update`.
  double rounding(std::size_t s) const { return roundings_[s]; }
  /// What an evaluation then leaves of it, however small what it compares is.
  double resolution(std::size_t s) const { return resolutions_[s]; }
  /// Rounding where it compares what has this magnitude: a part of it, at least of a machine unit.
  double rounding_of(std::size_t s, double compared_size) const;
  /// The threshold in a search along a solution, by the rounding there: beside a pole it is large for a
  /// moment only.
  double along_solution(std::size_t s, double rounding) const { return std::max(rounding, slack_[s]); }

  /// Lets an event function go back so far by the errors of the states, until it has left them behind; from
  /// the next `update` on. Where the errors are large for a moment only, as beside a pole, that is no reason
  /// to overlook what comes later: it is kMostSlack at the most.
  void give_slack(std::size_t s, double slack) { slack_[s] = std::min(slack, kMostSlack); }
  static constexpr double kMostSlack = 1e-6;
  /// The same, at once.
  void widen(std::size_t s, double slack) { now_[s] = slack_[s] = slack; }
  /// Takes it again, at once: the event function lies elsewhere.
  void take_slack(std::size_t s) {
    slack_[s] = 0;
    if (!program_.switches()[s].rate) now_[s] = roundings_[s];
  }
  /// Notes how far off an event function is, and takes its slack where that is beyond the errors of the
  /// states: by how much its threshold has become smaller then; it is the rounding there.
  std::optional<double> leave_behind(std::size_t s, double event_function, double rounding);

  /// Takes as much of the slack of a switch as is more than this.
  void limit_slack(std::size_t s, double most) { slack_[s] = std::min(slack_[s], most); }

  /// Notes at time t whether an event function lies this far on the side on which its switch does not stand,
  /// and only its slack lets it.
  void note_side(std::size_t s, double against, double rounding, double t);
  /// Since when the event function of a switch has been let lie there [s]; nothing where it does not.
  std::optional<double> let_since(std::size_t s) const { return let_since_[s]; }
  bool lets_any() const { return lets_ > 0; }

  /// Notes how far off an event function has been on the way.
  void note_excursion(std::size_t s, double event_function) {
    excursions_[s] = std::max(excursions_[s], std::abs(event_function));
  }
  /// How far the event function of a switch has been from zero since `forget`.
  double excursion(std::size_t s) const { return excursions_[s]; }
  void forget(std::size_t s) {
    excursions_[s] = 0;
    note_side(s, 0, 0, 0);
  }

 private:
  const network::Program& program_;
  std::vector<double> now_, roundings_, resolutions_;
  std::vector<double> slack_;  ///< of them, for the errors of the states
  std::vector<double> excursions_;
  std::vector<std::optional<double>> let_since_;  ///< see `let_since`
  long lets_ = 0;                                 ///< how many
  std::vector<bool> of_time_;                     ///< the event function follows the time alone, to rounding
};

}  // namespace oblique::solve
