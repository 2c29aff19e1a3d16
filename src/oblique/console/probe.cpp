// SPDX-License-Identifier: MIT
#include <oblique/console/probe.h>

#include <algorithm>
#include <utility>

namespace oblique::console {

Probe::Probe(ProbeSettings settings, double now) : settings_(std::move(settings)) {
  jump(now);
}

void Probe::jump(double now) {
  recording_ = false;
  last_side_.reset();
  triggered_at_.reset();
  if (!settings_.trigger) begin_trace(now);
}

std::vector<Trace> Probe::take_ended() {
  std::vector<Trace> ended = std::exchange(traces_, {});
  if (!recording_) return ended;
  traces_.push_back(std::move(ended.back()));
  ended.pop_back();
  return ended;
}

void Probe::begin_trace(double t) {
  if (begun_ >= settings_.most_traces) return;
  ++begun_;
  triggered_at_ = t;
  traces_.push_back({t, {}, std::vector<std::vector<double>>(settings_.names.size())});
  recording_ = true;
}

void Probe::look(double begin, double end, bool whole, const Read& read) {
  double from = begin;
  while (true) {
    if (recording_) {
      const double last = traces_.back().begin + settings_.length;
      record(from, std::min(end, last), whole || last <= end, read);
      last_side_.reset();
      if (last > end) return;
      recording_ = false;
      from = std::max(from, last);
    }
    if (!settings_.trigger || begun_ >= settings_.most_traces) return;
    if (triggered_at_) from = std::max(from, *triggered_at_ + settings_.trigger->hold_off);
    if (from > begin) last_side_.reset();
    if (from > end) return;
    const auto at = triggered(from, end, read);
    if (!at) return;
    begin_trace(*at);
    from = *at;
  }
}

/// Adds the rows of the present trace up to there; `to_row`: also one there, where they have no interval.
void Probe::record(double begin, double end, bool to_row, const Read& read) {
  const Trace& trace = traces_.back();
  if (settings_.interval > 0) {
    const auto due = [&] {
      return trace.begin + static_cast<double>(trace.times.size()) * settings_.interval;
    };
    while (due() <= end) add_row(due(), read);
    return;
  }
  const bool first = trace.times.empty();
  if (first || (trace.times.back() == begin && end > begin)) {
    read(begin, values_);
    bool jumped = first;
    for (std::size_t k = 0; k < trace.values.size(); ++k)
      jumped = jumped || trace.values[k].back() != values_[k];
    if (jumped) add_row(begin, read);
  }
  if (to_row && end > begin) add_row(end, read);
}

void Probe::add_row(double t, const Read& read) {
  Trace& trace = traces_.back();
  read(t, values_);
  trace.times.push_back(t);
  for (std::size_t k = 0; k < trace.values.size(); ++k) trace.values[k].push_back(values_[k]);
}

double Probe::beyond_level(double t, const Read& read) {
  read(t, values_);
  return values_.back() - settings_.trigger->level;
}

/// When the signal first passes the level within a piece, to the resolution of the clock. It is looked at
/// nine times a piece: of two passages closer together nothing is seen.
std::optional<double> Probe::triggered(double begin, double end, const Read& read) {
  constexpr int kParts = 8;
  const Trigger::Slope slope = settings_.trigger->slope;
  const auto passes = [&](double before, double after) {
    const bool rises = before <= 0 && after > 0, falls = before >= 0 && after < 0;
    return (rises && slope != Trigger::Slope::falling) || (falls && slope != Trigger::Slope::rising);
  };
  double low = begin, side = beyond_level(begin, read);
  // A jump between two pieces.
  const std::optional<double> before = std::exchange(last_side_, side);
  if (before && passes(*before, side)) return begin;
  for (int part = 1; part <= kParts; ++part) {
    double high = part == kParts ? end : begin + (end - begin) * part / kParts;
    const double other = beyond_level(high, read);
    if (!passes(side, other)) {
      low = high;
      side = other;
      last_side_ = side;
      continue;
    }
    for (double middle = low + (high - low) / 2; low < middle && middle < high;
         middle = low + (high - low) / 2) {
      const double at = beyond_level(middle, read);
      (passes(side, at) ? high : low) = middle;
    }
    last_side_ = other;
    return high;
  }
  return std::nullopt;
}

}  // namespace oblique::console
