// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/sliding_mode.h>
#include <oblique/solve/integrator/interpolant.h>
#include <oblique/solve/interruption.h>
#include <oblique/solve/readings/thresholds.h>

namespace oblique::solve {

/// Finds the first time in a step at which a switch turns over, a slide ends, or what follows a slide turns
/// over.
///
/// Of every event function the value and the exact rate along the solution are known at each sample. Between
/// two samples the cubic through these bounds the event function, and its error is known from a third sample
/// in the middle: where the bound stays below zero nothing happens, else the part is split, at the top of the
/// cubic where there is one, until it is below zero or a crossing is bracketed. So an extremum that passes
/// zero for a moment is found, not guessed.
class EventSearch {
 public:
  /// What is due at a time.
  struct Found {
    double time = 0;
    std::vector<std::pair<std::uint32_t, double>> turned;  ///< switches, and the positions that they go to
    bool slide_changes = false;                            ///< it ends, or what follows it turns over
  };

  /// All must outlive this.
  EventSearch(const network::Program& program, network::Workspace& workspace, SlidingMode& slide,
              Thresholds& thresholds, double span, const std::string& file);

  /// In (from, to]; all is in place at `from`. `sample_times` are times at which to look at least, the last
  /// one `to`.
  std::optional<Found> search(double from, std::span<const double> sample_times, const Interpolant& solution);

  /// Tops of event functions that the last search has seen just below zero, before what it has found.
  struct NearMiss {
    std::uint32_t number;  ///< in Program::switches
    double time;           ///< [s]
  };
  const std::vector<NearMiss>& near_misses() const { return near_misses_; }

  /// Of the event functions where the last search has ended the one that is nearest to zero, of those that
  /// depend on states and may turn over: its magnitude.
  double nearest() const { return nearest_; }

  /// How often to look between steps in all, where something turns fast.
  void limit_samples(double samples) { samples_left_ = samples; }
  /// `search` then throws Interrupted.
  void end_when(const Interruption& interruption) { interruption_ = interruption; }

 private:
  /// Of all that is watched: above 0 where it is due, and its rate. Switches first, then the lower and the
  /// upper edge of each unit that slides, then what follows on each side.
  struct Sample {
    double time = 0;
    std::vector<double> event_functions, roundings;  ///< of each switch
    std::vector<double> crossed, rates;
    double phase_rate = 0;  ///< [rad/s]
  };

  std::vector<double> slide_crossed();
  std::optional<std::pair<double, std::vector<double>>> slide_beside(double t, const Interpolant& solution);
  void sample(double t, const Interpolant& solution, Sample& at);
  void find_masked();
  bool is_due(const Sample& at) const;
  std::optional<Found> between(const Sample& from, const Sample& to, const Interpolant& solution);
  std::optional<Found> split(const Sample& from, const Sample& to, const std::vector<double>& errors,
                             int depth, const Interpolant& solution);
  Found locate(Sample from, Sample to, const Interpolant& solution);
  double edge_of_slide(const Sample& beyond, const Interpolant& solution);
  void pass(Sample& at);
  void note_way_to(const Found& found, double from, const Interpolant& solution, Sample& middle);
  void leave_behind(Sample& at);
  void let_go(Sample& at, const Interpolant& solution);

  const network::Program& program_;
  network::Workspace& workspace_;
  SlidingMode& slide_;
  Thresholds& thresholds_;
  const std::string& file_;
  double check_interval_;
  int splits_left_ = 0;
  double nearest_ = 0;          ///< see `nearest`
  double begin_ = 0, end_ = 0;  ///< [s] of the search
  double reached_ = 0;          ///< [s] where the event functions were evaluated last
  double branch_end_ = 0;       ///< [s] beyond which the branch of an algebraic loop is lost in this search
  Sample part_begin_;           ///< of the part between two samples that is searched
  double samples_left_ = std::numeric_limits<double>::infinity();
  Interruption interruption_;
  std::vector<NearMiss> near_misses_;
  std::vector<double> states_, rates_, event_functions_, event_function_rates_;
  std::vector<bool> masked_;  ///< of each switch, see `find_masked`
};

}  // namespace oblique::solve
