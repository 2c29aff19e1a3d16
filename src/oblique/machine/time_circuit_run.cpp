// SPDX-License-Identifier: MIT
#include <oblique/machine/time_circuit_run.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

namespace oblique::machine {
namespace {

double value_of(const TimeSignal& signal, double t, double a, double b) {
  switch (signal.kind) {
    case TimeSignal::Kind::clock:
      return t;
    case TimeSignal::Kind::sine:
      return std::exp(signal.growth * t) * std::sin(signal.rate * t + signal.phase);
    case TimeSignal::Kind::exponential:
      return std::exp(signal.growth * t);
    case TimeSignal::Kind::product:
      return a * b;
    case TimeSignal::Kind::comparison:
      return a > 0 ? 1 : 0;
    case TimeSignal::Kind::function:
      return text::evaluate(signal.function, [a](std::string_view) { return a; });
  }
  return 0;
}

/// Where the signals are looked at: the extremes of an argument of a function are met to 1e-4, and every
/// pulse between two turns of comparisons with the clock. Nothing where these would be too many.
std::vector<double> moments_of(const TimeCircuit& circuit, double until) {
  constexpr double kLeast = 4096, kMost = 1e6, kOfRadian = 40;
  double radians = 0;
  bool has_function = false;
  std::vector<double> turns{0, until};
  for (const TimeSignal& signal : circuit.signals) {
    radians = std::max({radians, signal.rate * until, std::abs(signal.growth) * until});
    has_function = has_function || signal.kind == TimeSignal::Kind::function;
    const bool of_clock = signal.kind == TimeSignal::Kind::comparison && signal.a.terms.size() == 1 &&
                          circuit.signals[signal.a.terms.front().signal].kind == TimeSignal::Kind::clock;
    if (of_clock) turns.push_back(-signal.a.constant / signal.a.terms.front().weight);
  }
  const double wanted = std::max(kLeast, kOfRadian * radians);
  if (wanted > kMost && has_function) return {};
  const int count = static_cast<int>(wanted > kMost ? kLeast : wanted);
  std::vector<double> moments;
  for (int k = 0; k <= count; ++k) moments.push_back(until * k / count);
  std::sort(turns.begin(), turns.end());
  constexpr int kOfPulse = 67;  // no whole part of a period that a pulse is likely to have
  for (std::size_t n = 1; n < turns.size(); ++n) {
    for (int k = 1; k < kOfPulse; ++k)
      moments.push_back(turns[n - 1] + (turns[n] - turns[n - 1]) * k / kOfPulse);
  }
  return moments;
}

}  // namespace

bool look_over_run(TimeCircuit& circuit, double until) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::vector<double> moments = moments_of(circuit, until);
  if (moments.empty()) return false;
  struct Peaks {
    double a = 0, b = 0, terms = 0, own = 0;
  };
  const std::size_t n = circuit.signals.size();
  std::vector<double> s(n);
  std::vector<Peaks> peaks(n);
  Peaks whole;
  for (TimeSignal& signal : circuit.signals) signal.range = {kInfinity, -kInfinity};
  const auto grow = [](double& peak, double value) { peak = std::max(peak, std::abs(value)); };
  const auto value = [&](const TimeSum& sum, double& most) {
    grow(most, sum.constant);
    double total = sum.constant;
    for (const TimeSum::Term& term : sum.terms) {
      grow(most, term.weight * s[term.signal]);
      total += term.weight * s[term.signal];
    }
    return total;
  };
  for (const double t : moments) {
    for (std::size_t i = 0; i < n; ++i) {
      TimeSignal& signal = circuit.signals[i];
      const double a = value(signal.a, peaks[i].terms), b = value(signal.b, peaks[i].terms);
      s[i] = value_of(signal, t, a, b);
      if (!std::isfinite(s[i])) return false;
      grow(peaks[i].a, a);
      grow(peaks[i].b, b);
      grow(peaks[i].own, s[i]);
      signal.range = {std::min(signal.range.low, a), std::max(signal.range.high, a)};
    }
    grow(whole.own, value(circuit.out, whole.terms));
  }
  const auto exceed = [&](double large, double small) {
    if (large > small) circuit.excess = std::max(circuit.excess, large / small);
  };
  exceed(whole.terms, whole.own);
  for (std::size_t i = 0; i < n; ++i) {
    const TimeSignal& signal = circuit.signals[i];
    const Peaks& seen = peaks[i];
    if (signal.kind == TimeSignal::Kind::product) exceed(seen.a * seen.b, seen.own);
    if (signal.kind == TimeSignal::Kind::function) exceed(seen.terms, signal.range.high - signal.range.low);
    exceed(std::exp(signal.growth * until), 1);
  }
  return true;
}

}  // namespace oblique::machine
