// SPDX-License-Identifier: MIT
#include <oblique/solve/integrator/overload.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <oblique/diagram/propose_scaling.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/events/switching.h>
#include <oblique/solve/run_errors.h>
#include <oblique/solve/solve_error.h>

namespace oblique::solve {
namespace {

constexpr double kNewPeak = 1e-7;  ///< relative excess over the last peak from which one is searched for

constexpr double kFarInside = 0.99;  ///< [machine unit]

bool is_outside(double value) {
  return std::abs(value) > 1;
}

}  // namespace

OverloadWatch::OverloadWatch(const network::Program& program, Switching& switching, std::string file,
                             bool halt)
    : program_(program),
      workspace_(switching.workspace()),
      switching_(switching),
      file_(std::move(file)),
      halt_(halt),
      records_(program.n_signals()),
      states_(program.n_states()),
      probe_(program.n_signals()),
      begin_(program.n_signals()),
      middle_(program.n_signals()),
      end_(program.n_signals()) {}

void OverloadWatch::evaluate(double t, std::vector<double>& values) {
  if (!switching_.signals(t, states_.data(), values.data())) {
    throw loop_error(program_, workspace_.trouble(), t, file_);
  }
}

/// The signals at t within the step that ends at `end`, or close by.
void OverloadWatch::evaluate_near(double t, double end, const Interpolant& solution,
                                  std::vector<double>& values) {
  // As far away as what the equation of a loop divides by there is again large beside the solver's errors.
  for (const double part : {0.0, 1.0 / 64, 1.0 / 8}) {
    const double distance = part * (end - t_);
    const double near = t + distance <= end ? t + distance : t - distance;
    solution.states_at(near, states_);
    if (switching_.signals(near, states_.data(), values.data())) return;
  }
  solution.states_at(t, states_);
  evaluate(t, values);
}

double OverloadWatch::value_at(double t, double end, std::size_t signal, const Interpolant& solution) {
  evaluate_near(t, end, solution, probe_);
  return probe_[signal];
}

void OverloadWatch::restart(double t, std::span<const double> states) {
  std::copy(states.begin(), states.end(), states_.begin());
  evaluate(t, begin_);
  t_ = t;
  for (std::size_t s = 0; s < records_.size(); ++s) {
    Record& record = records_[s];
    if (std::abs(begin_[s]) > std::abs(record.peak.value)) record.peak = {begin_[s], t};
    if (is_outside(begin_[s])) leave(record, t, begin_[s]);
    if (!is_outside(begin_[s])) come_back(record, t);
  }
}

double OverloadWatch::advance(double t, const Interpolant& solution) {
  if (halt_ && !overloads().empty()) {  // it began with one
    halted_ = true;
    return t_;
  }
  evaluate_near(t_ + (t - t_) / 2, t, solution, middle_);
  evaluate_near(t, t, solution, end_);
  for (std::size_t s = 0; s < records_.size(); ++s) look_at(s, t, solution);
  std::swap(begin_, end_);
  t_ = t;
  if (!halt_) return t;
  const std::vector<OverloadRecord> found = overloads();
  if (found.empty()) return t;
  halted_ = true;
  return found.front().first;
}

/// Whether an extreme between two samples is worth a search.
bool OverloadWatch::matters(const Record& record, double extreme, double before, double after) const {
  const bool new_peak = std::abs(extreme) > (1 + kNewPeak) * std::abs(record.peak.value);
  const bool other_side =
      is_outside(before) == is_outside(after) && is_outside(extreme) != is_outside(before);
  return new_peak || other_side;
}

void OverloadWatch::look_at(std::size_t signal, double t, const Interpolant& solution) {
  Record& record = records_[signal];
  const double middle_time = t_ + (t - t_) / 2;
  std::array<Sample, 4> samples{Sample{t_, begin_[signal]}, Sample{middle_time, middle_[signal]},
                                Sample{t, end_[signal]}, Sample{}};
  std::size_t n = 3;
  // The parabola middle + b u + c u² through the three, u from −1 to 1.
  const double b = (end_[signal] - begin_[signal]) / 2;
  const double c = (end_[signal] + begin_[signal]) / 2 - middle_[signal];
  if (std::abs(b) < 2 * std::abs(c)) {
    const double u = -b / (2 * c);
    const double time = middle_time + u * (t - t_) / 2, extreme = middle_[signal] - b * b / (4 * c);
    const double other = u < 0 ? begin_[signal] : end_[signal];
    if (matters(record, extreme, middle_[signal], other)) {
      // Far inside the range the parabola will do: nothing but a proposal of a scale depends on it.
      samples[3] =
          std::abs(extreme) < kFarInside ? Sample{time, extreme} : find_extreme(signal, time, t, solution);
      n = 4;
      std::sort(samples.begin(), samples.end(),
                [](const Sample& x, const Sample& y) { return x.time < y.time; });
    }
  }
  for (std::size_t k = 0; k < n; ++k) {
    const auto& [time, value] = samples[k];
    if (std::abs(value) > std::abs(record.peak.value)) record.peak = {value, time};
    if (k == 0) continue;
    const Sample& last = samples[k - 1];
    if (is_outside(last.value) && is_outside(value) && last.value * value > 0) {
      leave(record, last.time, value);                         // it still is; perhaps by more
    } else if (is_outside(last.value) && is_outside(value)) {  // across the whole range
      const Sample zero{last.time + (time - last.time) * last.value / (last.value - value), 0};
      come_back(record, find_crossing(signal, zero, last, t, solution));
      leave(record, find_crossing(signal, zero, samples[k], t, solution), value);
    } else if (is_outside(value)) {
      leave(record, find_crossing(signal, last, samples[k], t, solution), value);
    } else if (is_outside(last.value)) {
      come_back(record, find_crossing(signal, samples[k], last, t, solution));
    }
  }
}

/// From where a parabola puts an extreme: parabolas through ever closer neighbours there, whose error falls
/// with the third power of their distance.
OverloadWatch::Sample OverloadWatch::find_extreme(std::size_t signal, double near, double end,
                                                  const Interpolant& solution) {
  const auto at = [&](double time) {
    return Sample{time, value_at(std::clamp(time, t_, end), end, signal, solution)};
  };
  Sample best = at(near);
  for (const double part : {1.0 / 16, 1.0 / 256}) {
    const double distance = part * (end - t_);
    const double centre = std::clamp(best.time, t_ + distance, end - distance);
    const Sample before = at(centre - distance), middle = at(centre), after = at(centre + distance);
    const double b = (after.value - before.value) / 2, c = (after.value + before.value) / 2 - middle.value;
    const double u = c == 0 ? 0 : std::clamp(-b / (2 * c), -1.0, 1.0);
    const bool maximum = c < 0;
    for (const Sample& sample : {before, middle, after, at(centre + u * distance)}) {
      if (maximum ? sample.value > best.value : sample.value < best.value) best = sample;
    }
  }
  return best;
}

/// Where |signal| passes 1 between a sample inside the range and one outside: false position with the
/// Illinois rule.
double OverloadWatch::find_crossing(std::size_t signal, Sample inside, Sample outside, double end,
                                    const Interpolant& solution) {
  const double limit = std::copysign(1.0, outside.value);
  constexpr int kMostIterations = 60;
  double low = inside.time, high = outside.time;
  double at_low = (inside.value - limit) * limit, at_high = (outside.value - limit) * limit;
  if (at_low == 0) return low;
  for (int k = 0; k < kMostIterations && std::abs(high - low) > 1e-14 * std::abs(high); ++k) {
    const double time = high - at_high * (high - low) / (at_high - at_low);
    const double value = (value_at(time, end, signal, solution) - limit) * limit;
    if (value == 0) return time;
    if ((value > 0) == (at_high > 0)) {
      at_low /= 2;
    } else {
      low = high;
      at_low = at_high;
    }
    high = time;
    at_high = value;
  }
  return high;
}

void OverloadWatch::leave(Record& record, double t, double value) {
  if (!record.outside_since) {
    record.outside_since = t;
    record.counts = false;
  }
  record.counts = record.counts || std::abs(value) > 1 + diagram::kOverloadTolerance;
  if (record.counts && !record.first) record.first = record.outside_since;
}

void OverloadWatch::come_back(Record& record, double t) {
  if (!record.outside_since) return;
  if (record.counts) record.duration += t - *record.outside_since;
  record.outside_since.reset();
}

std::vector<Peak> OverloadWatch::peaks() const {
  std::vector<Peak> peaks;
  for (const Record& record : records_) peaks.push_back(record.peak);
  return peaks;
}

std::vector<OverloadRecord> OverloadWatch::overloads() const {
  std::vector<OverloadRecord> found;
  for (std::size_t s = 0; s < records_.size(); ++s) {
    const Record& record = records_[s];
    if (!record.first) continue;
    const double going_on = record.outside_since && record.counts ? t_ - *record.outside_since : 0;
    found.push_back({s, *record.first, record.duration + going_on, record.peak,
                     diagram::scale_for_peak(record.peak.value)});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const OverloadRecord& a, const OverloadRecord& b) { return a.first < b.first; });
  return found;
}

}  // namespace oblique::solve
