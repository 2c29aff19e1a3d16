// SPDX-License-Identifier: MIT
#include <oblique/solve/trust.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>

#include <oblique/network/program/program.h>
#include <oblique/solve/run.h>
#include <oblique/solve/solve_error.h>

namespace oblique::solve {
namespace {

constexpr double kFiner = 100, kLeastFiner = 3;  ///< times finer than the run
/// Below it rounding decides; a run that is nearly as fine is held beside a coarser one.
constexpr double kFinestTolerance = 1e-12;
constexpr std::int64_t kMostEffort = 20;      ///< steps of the other method, times those of the run
constexpr std::int64_t kLeastSteps = 10'000;  ///< that are allowed to it all the same

constexpr double kLost = 0.1;  ///< of the size: no digit stands

/// A time at which one run has had an event and the other not yet.
struct Between {
  double from, to;  ///< [s]
};

/// Whether two events come at one instant, or so nearly that no run can tell.
bool at_once(double before, double after) {
  constexpr double kAtOnce = 1e-12;  // of the time
  return after - before <= kAtOnce * std::abs(after);
}

/// Whether an event comes at the instant of the one before it.
bool comes_along(const std::vector<EventRecord>& events, std::size_t k) {
  return k > 0 && k < events.size() && at_once(events[k - 1].time, events[k].time);
}

/// At how many instants events come.
std::size_t instants(const std::vector<double>& times) {
  std::size_t found = times.empty() ? 0 : 1;
  for (std::size_t k = 1; k < times.size(); ++k)
    if (!at_once(times[k - 1], times[k])) ++found;
  return found;
}

/// Pairs the events of two runs. Of two comparisons with one event function a run may tell of either, or of
/// both: what comes along with a paired event in one run alone is no difference.
std::vector<Between> pair_events(const Run& a, const Run& b, Trust& trust) {
  std::vector<Between> pairs;
  std::size_t i = 0, j = 0;
  while (true) {
    if (i < a.events.size() && j < b.events.size() && a.events[i].what == b.events[j].what) {
      const auto [from, to] = std::minmax(a.events[i++].time, b.events[j++].time);
      pairs.push_back({from, to});
      trust.event_shift = std::max(trust.event_shift, to - from);
    } else if (comes_along(a.events, i)) {
      ++i;
    } else if (comes_along(b.events, j)) {
      ++j;
    } else {
      break;
    }
  }
  // Of many events only the first are listed, and all instants of them.
  const auto is_out = [](const Run& run, std::size_t k) { return k == run.events.size(); };
  const auto is_cut = [](const Run& run) { return run.event_count > static_cast<long>(run.events.size()); };
  const bool all_told = (is_out(a, i) && (is_out(b, j) || is_cut(a))) || (is_out(b, j) && is_cut(b));
  if (all_told && instants(a.event_times) == instants(b.event_times)) return pairs;
  double part = std::numeric_limits<double>::infinity();
  if (!is_out(a, i)) part = a.events[i].time;
  if (!is_out(b, j)) part = std::min(part, b.events[j].time);
  if (all_told) part = a.events.back().time;  // the lists end there, and their instants differ
  trust.events_part = std::min(part, trust.events_part.value_or(part));
  return pairs;
}

class Comparison {
 public:
  Comparison(const Run& done, Trust& trust) : done_(done), trust_(trust) {}

  void compare(const Run& check) {
    const std::vector<Between> jumps = pair_events(done_, check, trust_);
    compare(done_.trajectory, check.trajectory, jumps);
    compare(done_.extra, check.extra, jumps);
  }

 private:
  static bool jumps_at(double t, const std::vector<Between>& jumps) {
    constexpr double kRounding = 1e-14;
    const double around = kRounding * std::abs(t);
    return std::any_of(jumps.begin(), jumps.end(), [&](const Between& between) {
      return t >= between.from - around && t <= between.to + around;
    });
  }

  void compare(const Trajectory& a, const Trajectory& b, const std::vector<Between>& jumps) {
    constexpr std::size_t kPartAtEnd = 20;
    const std::size_t rows = std::min(a.rows(), b.rows());  // fewer where the run was halted or interrupted
    if (rows == 0) return;
    const std::size_t end = rows - 1 - (rows - 1) / kPartAtEnd;
    for (std::size_t row = 0; row < rows; ++row) {
      const double t = a.at(row, 0);
      if (jumps_at(t, jumps)) continue;
      for (std::size_t c = 0; c < trust_.outputs.size(); ++c) {
        OutputError& output = trust_.outputs[c];
        const double error = std::abs(a.at(row, c + 1) - b.at(row, c + 1));
        output.largest = std::max(output.largest, error);
        if (row >= end) output.at_end = std::max(output.at_end, error);
        if (error > kLost * output.size && error > 0) output.lost = std::min(t, output.lost.value_or(t));
      }
    }
  }

  const Run& done_;
  Trust& trust_;
};

/// The same run without those who listen to it.
RunOptions silent(const RunOptions& options) {
  RunOptions check = options;
  check.trust = false;
  check.progress = nullptr;
  check.on_sample = nullptr;
  check.sensitivity.clear();
  check.on_restart = nullptr;
  check.watch_overloads = check.halt_on_overload = false;
  check.extremes = false;
  return check;
}

/// One that goes another way: of several steps where this one is of one, and the reverse.
diagram::IntegrationMethod other_method(diagram::IntegrationMethod method) {
  using Method = diagram::IntegrationMethod;
  return method == Method::rodas ? Method::automatic : Method::rodas;
}

}  // namespace

int OutputError::digits(double error) const {
  constexpr double kMost = 15;
  if (!(error > 0)) return static_cast<int>(kMost);
  return static_cast<int>(std::clamp(std::floor(std::log10(size / error)), 0.0, kMost));
}

Trust estimate_error(const network::Program& program, const diagram::FlatDiagram& diagram,
                     const RunOptions& options, const Run& done) {
  Trust trust;
  trust.has_states = program.n_states() > 0;
  for (std::size_t c = 0; c < diagram.outputs.size(); ++c) {
    OutputError& output = trust.outputs.emplace_back();
    output.name = diagram.outputs[c].name;
    for (std::size_t row = 0; row < done.trajectory.rows(); ++row)
      output.size = std::max(output.size, std::abs(done.trajectory.at(row, c + 1)));
  }
  Comparison comparison(done, trust);
  RunOptions check = silent(options);
  const double finest = options.tolerance / kFinestTolerance;
  const double ratio = finest > kLeastFiner ? std::min(finest, kFiner) : 1 / kFiner;
  check.tolerance = options.tolerance / ratio;
  if (check.absolute_tolerance) *check.absolute_tolerance /= ratio;
  const auto hold_beside = [&] {
    const Run other = run(program, diagram, check);
    if (other.state.time < done.state.time) return;  // interrupted: it tells nothing of the rest
    trust.checks.push_back({check.tolerance, other.method.method});
    comparison.compare(other);
  };
  check.method = done.method.method;
  try {
    hold_beside();
  } catch (const SolveError& error) {
    trust.failure = error.diagnostics().front().what;
  }
  if (!trust.has_states) return trust;
  check.method = other_method(done.method.method);
  check.max_steps = std::min(options.max_steps, std::max(kLeastSteps, kMostEffort * done.statistics.steps));
  try {
    hold_beside();
  } catch (const SolveError&) {  // it is not the method for these equations, and the report does not name it
  }
  return trust;
}

}  // namespace oblique::solve
