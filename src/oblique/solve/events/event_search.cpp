// SPDX-License-Identifier: MIT
#include <oblique/solve/events/event_search.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/along_branch.h>
#include <oblique/solve/events/time_resolution.h>
#include <oblique/solve/run_errors.h>
#include <oblique/solve/solve_error.h>

namespace oblique::solve {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// At least so often over a run, however smooth the states are: nothing is known of what is made of them.
constexpr double kFewestSamples = 1000;

/// No further from sample to sample than a periodic function of the states turns by this [rad].
constexpr double kMostTurn = 0.5;
constexpr double kMostSamples = 1e6;  ///< in a step

/// How far beyond 0 and 1 the shares of a slide are where it has certainly ended: nearer than this it may run
/// along the edge, and no slide begins as far beyond.
constexpr double kEdge = 4e-6;
/// How far beyond they are where it is taken to have ended: the rates there tell the side that it leaves to.
constexpr double kTellingEdge = 4e-9;

/// Of the time from sample to sample: how far apart the rates of what has none that is known are taken.
constexpr double kRateStep = 1e-4;

/// The repulsion of a unit of which none is known: as if its sides drove together as strongly as they ever
/// did.
constexpr double kAttracted = -1;

/// A top that is as near below zero as this [machine unit] may be above it but for the errors of the states.
constexpr double kNearMiss = 1e-5;

constexpr int kDeepest = 60;
constexpr int kMostSplits = 1000;  ///< of a part between two samples: more is asked for by rounding alone

/// A cubic over [0, 1] by its values at the ends and its slopes there.
struct Cubic {
  double begin, end, begin_slope, end_slope;

  double value(double u) const {
    const double v = 1 - u;
    return v * v * (1 + 2 * u) * begin + u * u * (3 - 2 * u) * end +
           u * v * (v * begin_slope - u * end_slope);
  }

  /// Where it has its top; nothing where it has none inside.
  std::optional<double> top() const {
    // d/du = begin_slope + 2 b u + 3 c u²
    const double rise = end - begin;
    const double b = 3 * rise - 2 * begin_slope - end_slope, c = begin_slope + end_slope - 2 * rise;
    const double discriminant = b * b - 3 * c * begin_slope;
    if (!(discriminant > 0)) return std::nullopt;
    const double root = std::sqrt(discriminant);
    // Of the two zeros the one where the slope falls, by the form that loses no digits.
    const double at = b > 0 ? (3 * c == 0 ? kInfinity : (-b - root) / (3 * c)) : begin_slope / (-b + root);
    if (!(at > 0 && at < 1)) return std::nullopt;
    return at;
  }
};

/// From one sample to another; without rates a straight line.
Cubic cubic_of(double from, double to, double from_rate, double to_rate, double length) {
  const double secant = to - from;
  const bool known = std::isfinite(from_rate) && std::isfinite(to_rate);
  return {from, to, known ? from_rate * length : secant, known ? to_rate * length : secant};
}

}  // namespace

EventSearch::EventSearch(const network::Program& program, network::Workspace& workspace, SlidingMode& slide,
                         Thresholds& thresholds, double span, const std::string& file)
    : program_(program),
      workspace_(workspace),
      slide_(slide),
      thresholds_(thresholds),
      file_(file),
      check_interval_(span / kFewestSamples),
      states_(program.n_states()),
      rates_(program.n_states()),
      event_functions_(program.switches().size()),
      event_function_rates_(program.switches().size()),
      masked_(program.switches().size()) {
  for (const network::Switch& s : program.switches())
    check_interval_ = std::min(check_interval_, s.check_interval);
}

/// Of a slide, in the order of a sample: above 0 where a share leaves its range, the sides drive apart, an
/// event function jumps between them, or what follows on a side is due.
std::vector<double> EventSearch::slide_crossed() {
  std::vector<double> crossed;
  for (const double share : slide_.shares()) {
    crossed.push_back(-share - kEdge);
    crossed.push_back(share - 1 - kEdge);
  }
  for (std::size_t unit = 0; unit < slide_.units().size(); ++unit)
    crossed.push_back(slide_.repulsion(unit).value_or(kAttracted) - SlidingMode::kNoRepulsion);
  const auto jump = slide_.largest_jump();
  crossed.push_back(jump ? *jump - SlidingMode::drift() : -kInfinity);
  for (std::size_t side = 0; side < slide_.sides(); ++side) {
    for (std::size_t f = 0; f < slide_.followers().size(); ++f)
      crossed.push_back(slide_.crossed(side, f) - thresholds_[slide_.followers()[f]]);
  }
  return crossed;
}

/// The same a little apart from t, within the step, and that time; nothing where there is none.
std::optional<std::pair<double, std::vector<double>>> EventSearch::slide_beside(double t,
                                                                                const Interpolant& solution) {
  const double apart = kRateStep * std::min(check_interval_, end_ - begin_);
  if (!slide_.active() || !(apart > time_resolution(t))) return std::nullopt;
  const double beside = t + apart <= end_ ? t + apart : t - apart;
  bool known = false;
  reached_ = evaluate_along_branch(reached_, beside, workspace_, [&](double time) {
    solution.states_at(time, states_);
    known = slide_.evaluate(time, states_, false);
    return known;
  });
  if (!known || reached_ != beside) return std::nullopt;
  return std::pair(beside, slide_crossed());
}

void EventSearch::sample(double t, const Interpolant& solution, Sample& at) {
  interruption_.check();
  at.time = t;
  const auto beside = slide_beside(t, solution);
  std::optional<network::Evaluation> here;
  if (!(t > branch_end_)) {
    reached_ = evaluate_along_branch(reached_, t, workspace_, [&](double time) {
      solution.states_at(time, states_);
      here.reset();
      if (!slide_.active() || slide_.evaluate(time, states_, false))
        here = program_.event_functions(time, states_.data(), event_functions_.data(), workspace_);
      return here.has_value();
    });
  }
  if (!here) {
    if (!(t > branch_end_)) {
      if (workspace_.trouble().failure != network::LoopFailure::lost)
        throw loop_error(program_, workspace_.trouble(), t, file_);
      if (reached_ < t) branch_end_ = reached_;
    }
    // The branch may end because a switch is due that does not depend on it.
    solution.states_at(t, states_);
    workspace_.pass_failing_loops(true);
    here = program_.event_functions(t, states_.data(), event_functions_.data(), workspace_);
    workspace_.pass_failing_loops(false);
  }
  solution.rates_at(t, rates_);
  at.phase_rate = here.value().event_function_rates(rates_.data(), event_function_rates_.data());
  const std::size_t n = event_functions_.size();
  at.event_functions = event_functions_;
  at.roundings.resize(n);
  at.crossed.resize(n);
  at.rates.resize(n);
  for (std::size_t s = 0; s < n; ++s) {
    const bool closed = workspace_.discrete_state(program_.switches()[s].discrete_state) == 1;
    at.roundings[s] = thresholds_.rounding_of(s, here->compared_size(s));
    at.crossed[s] = (closed ? -event_functions_[s] : event_functions_[s]) -
                    thresholds_.along_solution(s, at.roundings[s]);
    at.rates[s] = closed ? -event_function_rates_[s] : event_function_rates_[s];
    if (slide_.rests(s)) at.crossed[s] -= SlidingMode::drift();
    if (program_.switches()[s].rate || slide_.holds(s) || slide_.follows(s) || masked_[s])
      at.crossed[s] = -kInfinity;
  }
  const std::vector<double> of_slide = slide_crossed();
  at.crossed.insert(at.crossed.end(), of_slide.begin(), of_slide.end());
  at.rates.resize(at.crossed.size(), std::numeric_limits<double>::quiet_NaN());
  if (!beside || beside->second.size() != of_slide.size()) return;
  for (std::size_t k = 0; k < of_slide.size(); ++k)
    at.rates[n + k] = (beside->second[k] - of_slide[k]) / (beside->first - t);
}

/// Finds which switches need not be looked at: what nothing reads, because another one masks it that is
/// looked at. It is put where it belongs when that one turns over, or anything else is settled; by itself it
/// would turn at every rounding (as what drives a limited lag does, that is at rest within its limits). Of
/// two that mask each other the last is looked at: in `out > limit and drive > 0` the limit. (Not what events
/// read: while it lags behind, one would be due that is not.)
void EventSearch::find_masked() {
  const network::SwitchStructure& structure = program_.switch_structure();
  std::vector<bool> asleep(workspace_.discrete_states().size(), true);
  for (std::size_t s = masked_.size(); s-- > 0;) {
    const auto& masks = structure.masks[s];
    masked_[s] =
        !structure.read_by_events[s] &&
        std::any_of(masks.begin(), masks.end(), [&](const network::Mask& mask) {
          return !asleep[mask.discrete_state] && workspace_.discrete_state(mask.discrete_state) == mask.value;
        });
    asleep[program_.switches()[s].discrete_state] = masked_[s] || slide_.holds(s) || slide_.follows(s);
  }
}

bool EventSearch::is_due(const Sample& at) const {
  return std::any_of(at.crossed.begin(), at.crossed.end(), [](double value) { return value > 0; });
}

std::optional<EventSearch::Found> EventSearch::search(double from, std::span<const double> sample_times,
                                                      const Interpolant& solution) {
  Sample left, right;
  near_misses_.clear();
  begin_ = from;
  end_ = sample_times.empty() ? from : sample_times.back();
  reached_ = sample_times.empty() ? from : sample_times.back();  // where the solver was last
  branch_end_ = kInfinity;
  find_masked();
  sample(from, solution, left);
  // Where the solver starts anew an event function may still lie within rounding of zero on the wrong side.
  for (double& value : left.crossed) value = std::min(value, 0.0);
  for (const double to : sample_times) {
    const double begin = left.time;
    sample(to, solution, right);
    const double turning = std::max(left.phase_rate, right.phase_rate);
    const double longest = std::min(check_interval_, turning > 0 ? kMostTurn / turning : kInfinity);
    if (!((to - begin) / longest <= samples_left_)) {
      throw SolveError(
          SolveError::Kind::step_budget, begin,
          {{file_, {}},
           fmt::format("from t = {:.9g} s on what a switch compares turns by {:.3g} rad a second: too fast "
                       "for every turn to be examined for a crossing",
                       begin, turning),
           {},
           "end the run before, keep the argument of the sine or cosine small, or give more 'max_steps' "
           "in [run]"});
    }
    const auto parts = static_cast<long>(std::clamp(std::ceil((to - begin) / longest), 1.0, kMostSamples));
    samples_left_ -= static_cast<double>(parts - 1);
    for (long k = 1; k <= parts; ++k) {
      if (parts > 1)
        sample(k == parts ? to : begin + (to - begin) * static_cast<double>(k) / static_cast<double>(parts),
               solution, right);
      if (auto found = between(left, right, solution)) {
        nearest_ = 0;
        note_way_to(*found, left.time, solution, right);
        return found;
      }
      std::swap(left, right);
      leave_behind(left);
      let_go(left, solution);
    }
  }
  return std::nullopt;
}

/// Goes on behind a sample before which nothing is due. Where event functions were there tells whether they
/// have left their place, should they come back within the same part.
void EventSearch::pass(Sample& at) {
  for (double& value : at.crossed) value = std::min(value, 0.0);
  for (std::size_t s = 0; s < at.event_functions.size(); ++s)
    thresholds_.note_excursion(s, at.event_functions[s]);
}

/// Notes how far from its place what has been found was on the way from a time at which it has turned over,
/// where no sample lies between: one that passes many levels in a step does not turn over at one place.
void EventSearch::note_way_to(const Found& found, double from, const Interpolant& solution, Sample& middle) {
  const bool is_noted = std::all_of(found.turned.begin(), found.turned.end(), [&](const auto& turned) {
    return thresholds_.excursion(turned.first) > 0;
  });
  if (is_noted || !(found.time > from)) return;
  sample(from + (found.time - from) / 2, solution, middle);
  for (const auto& turned : found.turned)
    thresholds_.note_excursion(turned.first, middle.event_functions[turned.first]);
}

/// Notes on which side every event function lies that may turn over, and takes its slack from those that are
/// beyond the errors of the states.
void EventSearch::leave_behind(Sample& at) {
  nearest_ = kInfinity;
  for (std::size_t s = 0; s < at.event_functions.size(); ++s) {
    const bool closed = workspace_.discrete_state(program_.switches()[s].discrete_state) == 1;
    double against = 0;
    if (at.crossed[s] != -kInfinity) {
      against = closed ? -at.event_functions[s] : at.event_functions[s];
      nearest_ = std::min(nearest_, std::abs(against));
    }
    thresholds_.note_side(s, slide_.rests(s) ? 0 : against, at.roundings[s], at.time);
    if (const auto less = thresholds_.leave_behind(s, at.event_functions[s], at.roundings[s]))
      at.crossed[s] += *less;
  }
}

/// Takes those from a slide that stayed at zero along with it at first, and go their way now.
void EventSearch::let_go(Sample& at, const Interpolant& solution) {
  constexpr double kGoes = 1e-5;  // of the fastest state
  std::vector<double> rates;
  for (std::size_t s = 0; s < at.event_functions.size(); ++s) {
    if (!slide_.rests(s) || slide_.holds(s) || slide_.follows(s)) continue;
    const bool closed = workspace_.discrete_state(program_.switches()[s].discrete_state) == 1;
    if (closed != (at.event_functions[s] > 0)) continue;
    if (rates.empty()) {
      rates.resize(at.event_functions.size());
      solution.states_at(at.time, states_);
      if (!slide_.evaluate(at.time, states_, false)) return;
      slide_.mixed_rates(rates);
    }
    const bool goes = closed == (rates[s] > 0) && std::abs(rates[s]) > kGoes * slide_.fastest();
    if (!goes && std::abs(at.event_functions[s]) < 2 * SlidingMode::drift()) continue;
    slide_.let_go(s);
    at.crossed[s] += SlidingMode::drift();
  }
}

std::optional<EventSearch::Found> EventSearch::between(const Sample& from, const Sample& to,
                                                       const Interpolant& solution) {
  const double length = to.time - from.time;
  const std::size_t n = to.crossed.size();
  part_begin_ = from;
  bool clear = true;
  for (std::size_t k = 0; k < n && clear; ++k) {
    const double reach = length * std::max(std::abs(from.rates[k]), std::abs(to.rates[k]));
    const double nearest = std::max(from.crossed[k], to.crossed[k]);
    clear = nearest == -kInfinity || nearest + reach < 0;
  }
  if (clear) return std::nullopt;
  Sample middle;
  sample(from.time + length / 2, solution, middle);
  std::vector<double> errors(n, 0.0);
  for (std::size_t k = 0; k < n; ++k) {
    if (to.crossed[k] == -kInfinity || from.crossed[k] == -kInfinity) continue;
    const Cubic cubic = cubic_of(from.crossed[k], to.crossed[k], from.rates[k], to.rates[k], length);
    // Half a part has a sixteenth of the error of a cubic; twice that to be safe.
    errors[k] = std::abs(cubic.value(0.5) - middle.crossed[k]) / 8;
  }
  splits_left_ = kMostSplits;
  if (auto found = split(from, middle, errors, 0, solution)) return found;
  pass(middle);
  return split(middle, to, errors, 0, solution);
}

/// `errors` is of each event function how far it may be from its cubic between the two.
std::optional<EventSearch::Found> EventSearch::split(const Sample& from, const Sample& to,
                                                     const std::vector<double>& errors, int depth,
                                                     const Interpolant& solution) {
  const double length = to.time - from.time;
  const bool due = is_due(to);
  if (depth > kDeepest || --splits_left_ < 0 || length <= time_resolution(to.time)) {
    if (due) return locate(from, to, solution);
    return std::nullopt;
  }
  double highest = 0, at = 0.5;
  bool hides = false;
  std::vector<NearMiss> near_misses;
  for (std::size_t k = 0; k < to.crossed.size(); ++k) {
    const double a = from.crossed[k], b = to.crossed[k];
    if (a == -kInfinity || b == -kInfinity || b > 0) continue;
    const Cubic cubic = cubic_of(a, b, from.rates[k], to.rates[k], length);
    const auto top = cubic.top();
    // The error of a cubic through values and slopes is none at the ends, and goes as u² (1 − u)².
    const auto bound = [&](double u) { return cubic.value(u) + 16 * errors[k] * u * u * (1 - u) * (1 - u); };
    double height = top ? bound(*top) : -kInfinity;
    for (const double u : {1.0 / 32, 0.125, 0.25, 0.5, 0.75, 0.875, 31.0 / 32})
      height = std::max(height, bound(u));
    if (!(height > 0)) {
      if (top && k < event_functions_.size() && height > -kNearMiss)
        near_misses.push_back({static_cast<std::uint32_t>(k), from.time + *top * length});
      continue;
    }
    if (!hides || height > highest) {
      highest = height;
      at = top ? std::clamp(*top, 0.02, 0.98) : 0.5;
    }
    hides = true;
  }
  if (!hides) {
    if (due) return locate(from, to, solution);
    near_misses_.insert(near_misses_.end(), near_misses.begin(), near_misses.end());
    return std::nullopt;
  }
  Sample between;
  sample(from.time + at * length, solution, between);
  if (!(between.time > from.time && between.time < to.time)) {
    if (due) return locate(from, to, solution);
    return std::nullopt;
  }
  // The error that the cubics have here tells those of the two parts, which fall with the fourth power of
  // their lengths; twice that to be safe.
  std::vector<double> before(errors.size(), 0.0), after(errors.size(), 0.0);
  for (std::size_t k = 0; k < errors.size(); ++k) {
    const double a = from.crossed[k], b = to.crossed[k];
    if (a == -kInfinity || b == -kInfinity) continue;
    const double off =
        std::abs(cubic_of(a, b, from.rates[k], to.rates[k], length).value(at) - between.crossed[k]);
    if (off <= 4 * std::numeric_limits<double>::epsilon() * (std::abs(a) + std::abs(b))) continue;
    const double largest = std::min(errors[k], off / (16 * at * at * (1 - at) * (1 - at)));
    before[k] = std::min(2 * std::pow(at, 4), 1.0) * largest;
    after[k] = std::min(2 * std::pow(1 - at, 4), 1.0) * largest;
  }
  if (auto found = split(from, between, before, depth + 1, solution)) return found;
  pass(between);
  return split(between, to, after, depth + 1, solution);
}

/// The first crossing between a sample at which nothing is due and one at which something is: secants, and
/// halves where they do not close the bracket.
EventSearch::Found EventSearch::locate(Sample from, Sample to, const Interpolant& solution) {
  Sample middle;
  bool halve = false;
  while (to.time - from.time > time_resolution(to.time)) {
    double at = kInfinity;
    for (std::size_t s = 0; s < to.crossed.size(); ++s) {
      if (to.crossed[s] <= 0 || !std::isfinite(from.crossed[s])) continue;
      const double part = from.crossed[s] / (from.crossed[s] - to.crossed[s]);
      at = std::min(at, from.time + part * (to.time - from.time));
    }
    const double half = from.time + (to.time - from.time) / 2;
    if (halve || !(at > from.time && at < to.time)) at = half;
    // A little beyond the secant's zero, so that the bracket closes from both sides.
    if (!halve) at = std::min(at + 0.01 * (at - from.time) * (to.time - at) / (to.time - from.time), to.time);
    if (!(at > from.time && at < to.time)) break;
    const double width = to.time - from.time;
    sample(at, solution, middle);
    std::swap(is_due(middle) ? to : from, middle);
    halve = to.time - from.time > width / 2;
  }
  Found found;
  found.time = to.time;
  const std::size_t n = event_functions_.size();
  for (std::size_t k = 0; k < to.crossed.size(); ++k) {
    if (!(to.crossed[k] > 0)) continue;
    if (k < n) {
      found.turned.emplace_back(static_cast<std::uint32_t>(k),
                                1 - workspace_.discrete_state(program_.switches()[k].discrete_state));
    } else {
      found.slide_changes = true;
    }
  }
  if (found.slide_changes && found.turned.empty()) found.time = edge_of_slide(to, solution);
  return found;
}

/// Where a share that is beyond its edge has passed it, at the latest `beyond`: it is seen there only once it
/// is certain, which may be much later where the shares hardly move. (Where the sides hardly drive any more
/// it is not the shares that tell.)
double EventSearch::edge_of_slide(const Sample& beyond, const Interpolant& solution) {
  constexpr double kDrives = 1e-3;
  const std::size_t n = event_functions_.size(), units = slide_.units().size();
  Sample middle;
  sample(beyond.time, solution, middle);
  std::vector<std::size_t> passed;  // places in a sample
  for (std::size_t k = n; k < n + 2 * units; ++k) {
    if (!(beyond.crossed[k] > 0)) continue;
    if (slide_.repulsion((k - n) / 2).value_or(kAttracted) > -kDrives) return beyond.time;
    passed.push_back(k);
  }
  const auto is_past = [&](const Sample& at) {
    return std::any_of(passed.begin(), passed.end(),
                       [&](std::size_t k) { return at.crossed[k] + kEdge > kTellingEdge; });
  };
  double before = part_begin_.time, past = beyond.time;
  if (passed.empty() || is_past(part_begin_)) return past;
  while (past - before > time_resolution(past)) {
    const double half = before + (past - before) / 2;
    if (!(half > before && half < past)) break;
    sample(half, solution, middle);
    (is_past(middle) ? past : before) = half;
  }
  return past;
}

}  // namespace oblique::solve
