// SPDX-License-Identifier: MIT
#include <oblique/solve/source_watch.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <oblique/solve/solve_error.h>

namespace oblique {
namespace {

/// A source that varies within a part of a step by this much of its size is told by its values at the ends.
constexpr double kSmooth = 0.25;

/// What is below this part of the largest value that a source has had is nothing.
constexpr double kNothing = 1e-9;

constexpr int kDeepest = 40;
constexpr std::size_t kMostLooks = 1'000'000;  ///< in a step

}  // namespace

SourceWatch::SourceWatch(const Program& program, const Workspace& workspace, bool outputs,
                         const std::string& file)
    : program_(program), workspace_(workspace), file_(file) {
  for (const Source& source : program.sources()) {
    if (source.acts || outputs) watched_.push_back(source);
  }
  if (!watched_.empty()) slots_ = program.source_slots();
  largest_.assign(watched_.size(), 0);
  if (active()) clocks_.resize(program.clocks().size());
  states_.resize(program.n_states());
}

/// The ranges of all sources over a part of the step.
void SourceWatch::bound(double from, double to) {
  const double length = step_end_ - step_begin_;
  for (std::size_t c = 0; c < clocks_.size(); ++c) {
    const auto at = [&](double t) {
      return at_begin_[c] + (at_end_[c] - at_begin_[c]) * ((t - step_begin_) / length);
    };
    const double a = at(from), b = at(to);
    clocks_[c] = {std::min(a, b), std::max(a, b)};
  }
  program_.source_ranges({from, to}, clocks_, workspace_, slots_);
}

SourceWatch::Values SourceWatch::values_at(double t) {
  bound(t, t);
  Values values;
  values.reserve(watched_.size());
  for (std::size_t k = 0; k < watched_.size(); ++k) {
    const double value = slots_[watched_[k].slot].low;
    values.push_back(value);
    if (std::isfinite(value)) largest_[k] = std::max(largest_[k], std::abs(value));
  }
  return values;
}

/// Whether every source goes from `from` to `to` as its values there tell.
bool SourceWatch::is_plain(double from, const Values& at_from, double to, const Values& at_to) {
  bound(from, to);
  for (std::size_t k = 0; k < watched_.size(); ++k) {
    const Interval slope = slots_[watched_[k].slope_slot];
    if (slope.low >= 0 || slope.high <= 0) continue;
    Interval value = slots_[watched_[k].slot];
    // From the value at the beginning no further than the slopes lead: tighter where the part is short.
    value.low = std::max(value.low, at_from[k] + slope.low * (to - from));
    value.high = std::min(value.high, at_from[k] + slope.high * (to - from));
    if (watched_[k].switch_index) {
      if (value.contains(0)) return false;
      continue;
    }
    const double shown = 2 * std::abs(at_to[k] - at_from[k]) +
                         kSmooth * std::min(std::abs(at_from[k]), std::abs(at_to[k])) +
                         kNothing * largest_[k];
    if (value.width() > shown) return false;
  }
  return true;
}

void SourceWatch::part(double from, const Values& at_from, double to, const Values& at_to, int depth) {
  if (--looks_left_ < 0) {
    throw SolveError(
        SolveError::Kind::step_budget, from,
        {{file_, {}},
         fmt::format("from t = {:.9g} s on what the time alone does changes too fast to look at all of it",
                     from),
         {},
         "end the run before, keep what is fast out of it, or give more 'max_steps' in [run]"});
  }
  const double middle = from + (to - from) / 2;
  const double resolution = 16 * std::numeric_limits<double>::epsilon() * std::abs(to);
  if (depth >= kDeepest || to - from <= resolution || times_.size() >= kMostLooks ||
      is_plain(from, at_from, to, at_to)) {
    times_.push_back(to);
    return;
  }
  const Values at_middle = values_at(middle);
  part(from, at_from, middle, at_middle, depth + 1);
  part(middle, at_middle, to, at_to, depth + 1);
}

const std::vector<double>& SourceWatch::looks(double from, double to, const Interpolant& solution) {
  times_.clear();
  if (!active() || !(to > from)) {
    times_.push_back(to);
    return times_;
  }
  step_begin_ = from;
  step_end_ = to;
  const auto clocks_at = [&](double t, std::vector<double>& values) {
    values.clear();
    if (clocks_.empty()) return;
    solution.states_at(t, states_);
    for (const std::size_t c : program_.clocks()) values.push_back(states_[c]);
  };
  clocks_at(from, at_begin_);
  clocks_at(to, at_end_);
  const Values at_from = values_at(from);
  part(from, at_from, to, values_at(to), 0);
  return times_;
}

}  // namespace oblique
