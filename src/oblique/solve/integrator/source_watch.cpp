// SPDX-License-Identifier: MIT
#include <oblique/solve/integrator/source_watch.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <oblique/network/program/program.h>
#include <oblique/solve/solve_error.h>

namespace oblique::solve {
namespace {

/// A source that varies within a part of a step by this much of its size is told by its values at the ends.
constexpr double kSmooth = 0.25;

/// One that acts on an algebraic loop with branches goes hardly further within a part than its ends show: of
/// what they show, and of its largest value. Beyond may lie the end of a branch, from which the loop does not
/// come back.
constexpr double kPlainOnBranch = 1.1, kSameOnBranch = 1e-3;

/// What is below this part of the largest value that a source has had is nothing.
constexpr double kNothing = 1e-9;

/// Of the largest value of a source: extremes are found to this, and overloads.
constexpr double kSameExtreme = 1e-6, kSamePeak = 1e-3;

/// An event function that is exactly zero at both ends of a part, and within it by bounds as near to zero as
/// this [machine unit], is the same throughout: a difference of two signals that are one, for a while, whose
/// bounds cannot know that.
constexpr double kStaysAtZero = 1e-4;

/// An event function of states that is as near to zero as this [machine unit] at both ends of a part, and
/// whose bounds are of its size, may rest there (a slide, a contact): bounds do not end that.
constexpr double kRestsAtZero = 1e-6;

/// Its range over a part in which it passes zero, beside what its ends show, where it does so once.
constexpr double kPlainPassage = 2;

/// A part at whose one end an event function is zero, to this part of what it is at the other, begins or ends
/// with an event. It has no other where the bounds go no further beyond zero than this part of it.
constexpr double kZeroAtOneEnd = 1e-6, kPlainBeginning = 0.1;

/// Where bounds of event functions of states cannot tell, so many parts of a step are enough (a difference of
/// two functions of one state, whose bounds do not know that): the search for events sees the rest.
constexpr int kMostForStates = 256;

/// Parts of a step that are shorter than this power of a half are not looked at for them.
constexpr int kDeepestForStates = 24;

/// Where bounds cannot tell of a peak: so many parts of a single step, of the first ones, and for every step
/// that follows. A peak in an otherwise quiet step takes two of every length down to its own. Of what the
/// time alone does more is seen: some hundred pulses in one step.
constexpr int kMostForPeaks = 4096, kSavedForPeaks = 20'000, kEarnedForPeaks = 16;
constexpr int kMostForPeaksOfTime = 1 << 15, kSavedForPeaksOfTime = 1 << 17, kEarnedForPeaksOfTime = 64;

constexpr int kDeepest = 40;
/// Of a source by states that may be any number, as a quotient of zeros, or one of the time that has no value
/// at either end, as beyond the edge of its branch.
constexpr int kDeepestUnknown = 6;
constexpr std::size_t kMostSamples = 1'000'000;  ///< in a step

/// Parts that are not longer than this are not halved.
double resolution(double t) {
  return 16 * std::numeric_limits<double>::epsilon() * std::abs(t);
}

}  // namespace

SourceWatch::SourceWatch(const network::Program& program, const network::Workspace& workspace, Shown shown,
                         const std::string& file)
    : program_(program),
      workspace_(workspace),
      file_(file),
      shown_(shown),
      of_states_{kMostForPeaks, kSavedForPeaks, kEarnedForPeaks},
      of_time_{kMostForPeaksOfTime, kSavedForPeaksOfTime, kEarnedForPeaksOfTime} {
  for (const network::Source& source : program.sources()) {
    if (source.acts || shown != Shown::nothing) watched_.push_back(source);
  }
  if (!watched_.empty()) slots_ = program.source_slots();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  largest_.assign(watched_.size(), 0);
  widest_.assign(watched_.size(), 0);
  seen_.assign(watched_.size(), {kInfinity, -kInfinity});
  masked_.assign(watched_.size(), false);
  if (!active()) return;
  ranges_.resize(program.source_states().size());
  states_.resize(program.n_states());
  rates_.resize(program.n_states());
}

/// The ranges of all sources over a part of the step.
void SourceWatch::bound(double from, const Values& at_from, double to, const Values& at_to) {
  constexpr double kBend =
      2 * 4.0 / 27;  // a cubic goes 4/27 of the derivatives' difference off its chord, at most
  for (std::size_t k = 0; k < ranges_.size(); ++k) {
    const double a = at_from.states[k], b = at_to.states[k];
    double off = 0;
    if (k >= program_.clocks() && to > from) {
      const double chord = (b - a) / (to - from);
      off = kBend * (to - from) * (std::abs(at_from.rates[k] - chord) + std::abs(at_to.rates[k] - chord));
    }
    ranges_[k] = {std::min(a, b) - off, std::max(a, b) + off};
  }
  program_.source_ranges({from, to}, ranges_, workspace_, slots_);
}

SourceWatch::Values SourceWatch::values_at(double t) {
  Values values;
  if (!ranges_.empty()) {
    solution_->states_at(t, states_);
    if (ranges_.size() > program_.clocks()) solution_->rates_at(t, rates_);
    for (const std::size_t i : program_.source_states()) {
      values.states.push_back(states_[i]);
      values.rates.push_back(rates_[i]);
    }
  }
  bound(t, values, t, values);
  values.sources.reserve(watched_.size());
  for (std::size_t k = 0; k < watched_.size(); ++k) {
    const double value = slots_[watched_[k].slot].low;
    values.sources.push_back(value);
    if (!std::isfinite(value)) continue;
    largest_[k] = std::max(largest_[k], std::abs(value));
    seen_[k] = {std::min(seen_[k].low, value), std::max(seen_[k].high, value)};
  }
  return values;
}

/// Whether an event function with these values at the ends of a part, and this range between, which holds
/// zero, may pass it in between unseen.
bool SourceWatch::may_turn(const network::Source& source, double a, double b, const network::Interval& range,
                           int depth) {
  if (!source.by_states) return !(a == 0 && b == 0 && range.width() <= kStaysAtZero);
  if (std::max(std::abs(a), std::abs(b)) <= kRestsAtZero && range.width() <= kStaysAtZero) return false;
  const bool passes = (a < 0 && b > 0) || (a > 0 && b < 0);
  if (passes && range.width() <= kPlainPassage * std::abs(b - a)) return false;
  const double larger = std::abs(a) > std::abs(b) ? a : b, beyond = larger > 0 ? -range.low : range.high;
  if (std::min(std::abs(a), std::abs(b)) <= kZeroAtOneEnd * std::abs(larger) &&
      beyond <= kPlainBeginning * std::abs(larger))
    return false;
  return depth < kDeepestForStates && parts_for_states_++ < kMostForStates;
}

/// Whether a source with this range over a part of a step, and these values at its ends, may have a new
/// extreme there, or leave ±1 machine unit and come back.
bool SourceWatch::hides_extreme(std::size_t k, double a, double b, const network::Interval& range) const {
  if (shown_ == Shown::nothing) return false;
  const double same = (shown_ == Shown::extremes ? kSameExtreme : kSamePeak) * largest_[k];
  network::Interval known = seen_[k];
  if (shown_ == Shown::overloads) {
    if (range.low >= -1 - same && range.high <= 1 + same) return false;
    const bool stays_outside = range.low > 1 - same || range.high < same - 1;
    if (!stays_outside) known = {std::min(a, b), std::max(a, b)};
  }
  return range.high > known.high + same || range.low < known.low - same;
}

/// Whether a source of the time is next to nothing at both ends of a part, beside what bounds have ever left
/// open: it may have a peak in between, or be zero because its terms cancel, which no bounds can know.
bool SourceWatch::is_nothing(std::size_t k, double a, double b) const {
  return std::max(std::abs(a), std::abs(b)) <= kNothing * widest_[k];
}

/// Whether not every source goes from `from` to `to` as its values there tell.
SourceWatch::Hidden SourceWatch::hidden(double from, const Values& at_from, double to, const Values& at_to,
                                        int depth) {
  bound(from, at_from, to, at_to);
  Hidden found = Hidden::nothing;
  for (std::size_t k = 0; k < watched_.size(); ++k) {
    if (masked_[k]) continue;
    const double a = at_from.sources[k], b = at_to.sources[k];
    network::Interval value = slots_[watched_[k].slot];
    if (!watched_[k].by_states) {
      const network::Interval derivative = slots_[watched_[k].derivative_slot];
      if (derivative.low >= 0 || derivative.high <= 0) continue;
      // From the value at the beginning no further than the derivatives lead: tighter where the part is
      // short.
      value.low = std::max(value.low, a + derivative.low * (to - from));
      value.high = std::min(value.high, a + derivative.high * (to - from));
      if (std::isfinite(value.width())) widest_[k] = std::max(widest_[k], value.width());
    }
    const bool may_be_peak = !watched_[k].by_states && is_nothing(k, a, b);
    if (may_be_peak && of_time_.left <= 0) continue;
    const Hidden kind = may_be_peak ? Hidden::peak_of_time : Hidden::other;
    if (watched_[k].switch_index) {
      if (value.contains(0) && may_turn(watched_[k], a, b, value, depth)) found = std::max(found, kind);
      continue;
    }
    const double shown =
        watched_[k].on_branch
            ? kPlainOnBranch * std::abs(b - a) + kSameOnBranch * largest_[k]
            : 2 * std::abs(b - a) + kSmooth * std::min(std::abs(a), std::abs(b)) + kNothing * largest_[k];
    const bool beyond = !std::isfinite(a) && !std::isfinite(b);
    if (depth >= kDeepestUnknown && !std::isfinite(value.width()) && (watched_[k].by_states || beyond))
      continue;
    const bool is_shown = value.width() <= shown;
    if (!watched_[k].by_states) {
      if (!is_shown || hides_extreme(k, a, b, value)) found = std::max(found, kind);
    } else if (!is_shown && of_states_.left > 0) {
      found = std::max(found, Hidden::peak_of_states);
    }
    if (found == Hidden::other) break;
  }
  return found;
}

/// Takes the halves of a part that may hide something, as far as they are parts that may.
void SourceWatch::part(double from, const Values& at_from, double to, const Values& at_to, int depth) {
  samples_left_ -= 2;  // its halves
  if (samples_left_ < 0) {
    throw SolveError(
        SolveError::Kind::step_budget, from,
        {{file_, {}},
         fmt::format("from t = {:.9g} s on the signals change too fast for every change to be examined",
                     from),
         {},
         "end the run before, leave fast signals out, or give more 'max_steps' in [run]"});
  }
  const double middle = from + (to - from) / 2;
  const auto take = [&](double a, const Values& at_a, double b, const Values& at_b, Hidden what) {
    const bool goes_on = depth + 1 < kDeepest && b - a > resolution(b) && times_.size() < kMostSamples;
    if (what == Hidden::nothing || !goes_on) return times_.push_back(b);
    if (what == Hidden::peak_of_states) --of_states_.left;
    if (what == Hidden::peak_of_time) --of_time_.left;
    part(a, at_a, b, at_b, depth + 1);
  };
  const Values at_middle = values_at(middle);
  const Hidden first = hidden(from, at_from, middle, at_middle, depth + 1);
  const Hidden second = hidden(middle, at_middle, to, at_to, depth + 1);
  const bool both = first != Hidden::nothing && second != Hidden::nothing;
  const int of_states = both ? of_states_.left / 2 : 0,
            of_time = both ? of_time_.left / 2 : 0;  // of the other
  of_states_.left -= of_states;
  of_time_.left -= of_time;
  take(from, at_from, middle, at_middle, first);
  of_states_.left += of_states;
  of_time_.left += of_time;
  take(middle, at_middle, to, at_to, second);
}

bool SourceWatch::acts_anew() const {
  for (std::size_t k = 0; k < watched_.size(); ++k) {
    if (masked_[k] && !is_masked(watched_[k].masks, workspace_.discrete_states())) return true;
  }
  return false;
}

const std::vector<double>& SourceWatch::sample_times(double from, double to, const Interpolant& solution,
                                                     bool slides) {
  times_.clear();
  for (std::size_t k = 0; k < watched_.size(); ++k)
    masked_[k] = !slides && is_masked(watched_[k].masks, workspace_.discrete_states());
  if (!active() || !(to > from)) {
    times_.push_back(to);
    return times_;
  }
  solution_ = &solution;
  parts_for_states_ = 0;
  of_states_.begin_step();
  of_time_.begin_step();
  const Values at_from = values_at(from), at_to = values_at(to);
  if (to - from <= resolution(to) || hidden(from, at_from, to, at_to, 0) == Hidden::nothing) {
    times_.push_back(to);
  } else {
    part(from, at_from, to, at_to, 0);
  }
  of_states_.end_step();
  of_time_.end_step();
  return times_;
}

}  // namespace oblique::solve
