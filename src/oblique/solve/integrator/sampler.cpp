// SPDX-License-Identifier: MIT
#include <oblique/solve/integrator/sampler.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/along_branch.h>
#include <oblique/solve/run_errors.h>
#include <oblique/solve/solve_error.h>

namespace oblique::solve {
namespace {

[[noreturn]] void throw_not_finite(const std::string& file, const std::string& signal, double time) {
  throw SolveError(
      SolveError::Kind::blow_up, time,
      {{file, {}},
       fmt::format("the signal '{}' is not a finite number at t = {:.6g} s", signal, time),
       {},
       "look for a division by zero, a root or logarithm of a negative signal, or an exponential of a "
       "large one"});
}

}  // namespace

Sampler::Sampler(const network::Program& program, const diagram::FlatDiagram& diagram,
                 const RunOptions& options, network::Workspace& workspace, Switching& switching)
    : program_(program),
      diagram_(diagram),
      options_(options),
      workspace_(workspace),
      switching_(switching),
      runaway_(program, options.from ? options.from->time : 0, options.until, options.watch_overloads),
      states_(program.n_states()),
      signals_(program.n_signals()),
      row_(run_columns(diagram, options).size()) {
  result.trajectory = Trajectory(run_columns(diagram, options));
  result.extra = result.trajectory;
  result.peaks.resize(program.n_signals());
  if (options.extremes) result.extremes.resize(diagram.outputs.size());
}

void Sampler::advance(double t, const Interpolant& solution) {
  double last = t;
  while (true) {
    const bool grid_left = next_sample_ < options_.samples;
    const bool extra_left = next_extra_ < options_.extra_times.size();
    const double grid_time = grid_left ? sample_time(next_sample_) : options_.until + 1;
    const double extra_time = extra_left ? options_.extra_times[next_extra_] : options_.until + 1;
    const double time = std::min(grid_time, extra_time);
    if ((!grid_left && !extra_left) || time > t) return;
    evaluate(last, time, solution);
    last = time;
    runaway_.look_at(time, signals_);
    if (further_columns) further_columns(time, states_, std::span(row_).subspan(1 + diagram_.outputs.size()));
    if (grid_left && grid_time == time) {
      result.trajectory.add_row(row_);
      if (options_.on_sample) options_.on_sample(time, states_, workspace_.discrete_states());
      ++next_sample_;
    }
    if (extra_left && extra_time == time) {
      result.extra.add_row(row_);
      ++next_extra_;
    }
  }
}

/// What follows the time through a loop, or states that a solver integrates by long steps, turns wherever it
/// likes: no part that is looked at is longer than a three-hundredth of the run.
void Sampler::watch(double from, double to, const Interpolant& solution) {
  constexpr double kFewest = 300;
  if (!options_.extremes) return;
  const double span = options_.until - (options_.from ? options_.from->time : 0);
  const int parts = std::max(1, static_cast<int>(std::ceil(kFewest * (to - from) / span)));
  double last = to, begin = from;
  for (int part = 1; part <= parts; ++part) {
    const double end = part == parts ? to : from + (to - from) * part / parts;
    last = watch_part(last, begin, end, solution);
    begin = end;
  }
}

/// In the middle of the part and at its ends; and where a parabola through these has its top, if that may be
/// an extreme of the run, by parabolas through ever closer neighbours, whose error falls with the third power
/// of their distance. Missed is a second top. `last` is where something was evaluated last; where it is then.
double Sampler::watch_part(double last, double from, double to, const Interpolant& solution) {
  const auto at = [&](double time) {
    evaluate(last, time, solution);
    last = time;
    keep_extremes(time);
  };
  at(from);
  begin_ = row_;
  at((from + to) / 2);
  middle_ = row_;
  at(to);
  const std::vector<double> end = row_;
  for (std::size_t c = 1; c <= diagram_.outputs.size(); ++c) {
    const double curvature = begin_[c] - 2 * middle_[c] + end[c];
    double best = 0.5 - (end[c] - begin_[c]) / (4 * curvature);  // as a part of the segment
    if (!(best > 0 && best < 1)) continue;
    const auto [low, high] = std::minmax({begin_[c], middle_[c], end[c]});
    const double doubt = high - low;  // the parabola may miss as much
    const Extremes& known = result.extremes[c - 1];
    if (curvature < 0 ? high + doubt <= known.maximum.value : low - doubt >= known.minimum.value) continue;
    const auto value_at = [&](double part) {
      at(from + part * (to - from));
      return row_[c];
    };
    double extreme = value_at(best);
    for (const double distance : {1.0 / 4, 1.0 / 16, 1.0 / 64, 1.0 / 256}) {
      const double centre = std::clamp(best, distance, 1 - distance);
      const auto look_at = [&](double part, double value) {
        if (curvature < 0 ? value > extreme : value < extreme)
          std::tie(best, extreme) = std::pair(part, value);
      };
      const double before = value_at(centre - distance), middle = value_at(centre),
                   after = value_at(centre + distance);
      look_at(centre - distance, before);
      look_at(centre, middle);
      look_at(centre + distance, after);
      const double bend = before - 2 * middle + after;
      const double top = centre - distance * (after - before) / (2 * bend);
      if (std::abs(top - centre) < distance) look_at(top, value_at(top));
    }
  }
  return last;
}

void Sampler::keep_extremes(double time) {
  for (std::size_t i = 0; i < result.extremes.size(); ++i) {
    Extremes& extremes = result.extremes[i];
    const double value = row_[i + 1];
    if (value > extremes.maximum.value) extremes.maximum = {value, time};
    if (value < extremes.minimum.value) extremes.minimum = {value, time};
  }
}

double Sampler::sample_time(int k) const {
  const double begin = options_.from ? options_.from->time : 0;
  if (k + 1 == options_.samples) return options_.until;
  return begin + (options_.until - begin) * k / (options_.samples - 1);
}

/// `last` is where something was evaluated last.
void Sampler::evaluate(double last, double time, const Interpolant& solution) {
  constexpr double kSameTime = 1e-9;  // of the run: at the end of a branch stands the last value on it
  bool known = false;
  const auto signals_at = [&](double at) {
    solution.states_at(at, states_);
    return known = switching_.signals(at, states_.data(), signals_.data());
  };
  const double reached = evaluate_along_branch(last, time, workspace_, signals_at);
  const double span = options_.until - (options_.from ? options_.from->time : 0);
  const bool is_end = reached != time || !known;
  if (is_end && (std::abs(time - reached) > kSameTime * span || !signals_at(reached)))
    throw loop_error(program_, workspace_.trouble(), time, diagram_.file);
  row_[0] = time;
  for (std::size_t i = 0; i < diagram_.outputs.size(); ++i) {
    const diagram::FlatOutput& output = diagram_.outputs[i];
    row_[i + 1] = output.scale * signals_[program_.signal_index(output.signal)] + output.offset;
  }
  for (std::size_t s = 0; s < signals_.size(); ++s) {
    found_no_value_ = !std::isfinite(signals_[s]);
    if (found_no_value_) throw_not_finite(diagram_.file, program_.signal_names()[s], time);
    if (std::abs(signals_[s]) > std::abs(result.peaks[s].value)) result.peaks[s] = {signals_[s], time};
  }
}

}  // namespace oblique::solve
