// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/event_search.h>
#include <oblique/solve/integrator/interpolant.h>
#include <oblique/solve/readings/event_functions.h>

namespace oblique::solve {

/// Finds where switches turn over next, and keeps which they are until they have been settled there. Not
/// installed.
class EventLocation {
 public:
  /// All must outlive this; `span` is the length of the run [s].
  EventLocation(const network::Program& program, network::Workspace& workspace, SlidingMode& slide,
                EventFunctions& event_functions, double span, const std::string& file);

  void limit_samples(double samples) { search_.limit_samples(samples); }
  void end_when(const Interruption& interruption) { search_.end_when(interruption); }

  /// How long after t the next switch that follows time alone turns over [s], of all, or of those that are
  /// let pass, or of those that end a segment; it is announced. Nothing where none does.
  enum class Of { all, let_pass, ends_of_segments };
  std::optional<double> known_wait(double t, std::span<const double> x, Of which);
  /// Whether those that follow time alone and were due last are let pass from now on: no segment ends where
  /// they turn over.
  void let_pass(bool pass);
  bool lets_pass() const;

  /// The first crossing after `from`, which is announced; nothing where there is none: see EventSearch.
  std::optional<EventSearch::Found> search(double from, std::span<const double> sample_times,
                                           const Interpolant& solution);

  double nearest() const { return search_.nearest(); }
  const std::vector<EventSearch::NearMiss>& near_misses() const { return search_.near_misses(); }
  const Announced& announced() const { return announced_; }
  /// Whether what was found last ends a slide, or turns over what follows it.
  bool slide_changes() const { return slide_changes_; }
  /// At the beginning of an instant that is settled: withdraws switches that follow time alone and are not
  /// due yet at t, where the event functions were evaluated last: the segment may have ended before their
  /// time.
  void withdraw_early(double t);
  /// Withdraws switches whose event functions have moved away from zero at t; or all, but for those that
  /// follow the time alone, of which no jump of states takes one back.
  void withdraw_past(double t, bool all);
  void withdraw_all() {
    announced_.assign(announced_.size(), std::nullopt);
    slide_changes_ = false;
  }

 private:
  bool is_due(std::size_t s, double t) const;

  const network::Program& program_;
  const network::Workspace& workspace_;
  EventFunctions& event_functions_;
  EventSearch search_;
  Announced announced_;
  bool slide_changes_ = false;    ///< see `slide_changes`
  std::vector<std::size_t> due_;  ///< switches that follow time alone, when it was settled last
  std::vector<bool> let_pass_;    ///< of each switch
};

}  // namespace oblique::solve
