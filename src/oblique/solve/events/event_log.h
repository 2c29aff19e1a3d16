// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/sliding_mode.h>
#include <oblique/solve/run_records.h>
#include <oblique/solve/solve_error.h>

namespace oblique::solve {

/// What a run reports of its switches and events: what happened, and what could not be seen. Not installed.
class EventLog {
 public:
  /// `file` names the diagram in messages. Both must outlive this.
  EventLog(const network::Program& program, const std::string& file) : program_(program), file_(file) {}

  void record(double t, std::string what);
  /// That the comparison of a switch holds from now on, or no longer.
  void record_turn(std::size_t s, double position, double t);
  /// Which slides have begun and ended since the units `before` slid, with what is uncertain of each that has
  /// ended.
  void record_slides(const std::vector<std::uint32_t>& before, const std::vector<SlidingMode::Doubt>& doubts,
                     const SlidingMode& slide, double t);

  /// Looks for what would turn over along with what slides, and does not: a warning where it was so before t,
  /// too.
  void look_along(const SlidingMode& slide, double t);

  /// A warning; once, however often it comes.
  void warn(text::Diagnostic warning);
  /// Tells that nothing decides where the solution goes.
  void warn_of_no_side(std::uint32_t unit, double t);

  /// Tells that what a switch compares lies since a time on the other side than the one on which the switch
  /// stands, by less than its error.
  void warn_of_hidden(std::uint32_t s, bool holds, double since, double t, double error);
  /// Tells that nothing decides on which side a solution stops that slid.
  void warn_of_halt(std::uint32_t unit, double t);

  /// Tells that a solution stops at a level from which either side would lead it away.
  void warn_of_stop(std::uint32_t unit, double t);

  /// Tells that it makes a difference at t that a comparison does not hold which has rested at its level
  /// since an earlier time, by its own turn.
  void warn_of_rest(std::uint32_t unit, double since, double t);

  /// Tells that a comparison holds at its level, where something else has stopped what it compares.
  void warn_of_held(std::uint32_t s, double t);

  /// Tells that switches which depend on each other may stand in more than one way, and how they do.
  void warn_of_choice(const std::vector<std::uint32_t>& switches, const network::Workspace& workspace,
                      double t);
  /// Withdraws all that: where a run starts, an event has come since.
  void forget_choices();

  /// The error of a run in which this block and others, `count` in all, are at their switching points at one
  /// instant and act on each other, where only so many can be decided together.
  SolveError too_many(const std::string& block, std::size_t count, std::size_t most, double t) const;
  /// The error of a run in which this block switches without end.
  SolveError endless(const std::string& block, const std::string& what, double t) const;
  /// The same of what was recorded last.
  SolveError endless(const std::string& what, double t) const;
  /// That of one whose turns have piled up at `at`, where it goes on at t by errors alone.
  SolveError piled_up(const std::string& block, const std::string& comparison, double at, double t) const;

  /// The first thousand events, and how many there were.
  const std::vector<EventRecord>& records() const { return records_; }
  long count() const { return count_; }
  /// When they came, of the first million.
  const std::vector<double>& times() const { return times_; }
  /// What could not be seen.
  const std::vector<text::Diagnostic>& warnings() const { return warnings_; }

 private:
  const network::Switch& first_of(std::uint32_t unit) const;
  void warn_of_unit(std::uint32_t unit, const char* what, const std::string& rest, const char* remedy);
  void warn_of_leaving(std::uint32_t unit, SlidingMode::Doubt doubt, double t);
  void warn_of_uncounted(const SlidingMode& slide, double t);
  void warn_of_acting_together(const SlidingMode& slide, double t);
  void warn_of_turning_along(std::uint32_t s, double since);

  const network::Program& program_;
  const std::string& file_;
  std::vector<double> times_;
  std::vector<EventRecord> records_;
  long count_ = 0;
  std::vector<std::optional<double>> along_since_;  ///< of each switch: since when it would turn along [s]
  std::vector<text::Diagnostic> warnings_;
};

}  // namespace oblique::solve
