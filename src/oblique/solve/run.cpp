// SPDX-License-Identifier: MIT
#include <oblique/solve/run.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <oblique/solve/rest.h>
#include <oblique/solve/solve_error.h>

namespace oblique {
namespace {

/// Time of a row of the grid [s].
double sample_time(const RunOptions& options, int k) {
  return k + 1 == options.samples ? options.until : options.until * k / (options.samples - 1);
}

/// The watch on overloads, where there is to be one.
class Watch {
 public:
  Watch(const Program& program, Workspace& workspace, const std::string& file, const RunOptions& options) {
    if (options.watch_overloads || options.halt_on_overload) {
      watch_.emplace(program, workspace, file, options.halt_on_overload);
    }
  }

  void restart(double t, std::span<const double> states) {
    if (watch_) watch_->restart(t, states);
  }

  double advance(double t, const OverloadWatch::StatesAt& states_at) {
    return watch_ ? watch_->advance(t, states_at) : t;
  }

  /// A diagram without states has no steps: its rows stand in for them.
  double advance_along_rows(const RunOptions& options) {
    double reached = options.until;
    for (int k = 1; watch_ && k < options.samples && !halted(); ++k) {
      reached = watch_->advance(sample_time(options, k), [](double, std::span<double>) {});
    }
    return reached;
  }

  bool halted() const { return watch_ && watch_->halted(); }

  void report(Run& run) const {
    if (!watch_) return;
    run.peaks = watch_->peaks();
    run.overloads = watch_->overloads();
    run.halted = watch_->halted();
  }

 private:
  std::optional<OverloadWatch> watch_;
};

/// Collects rows at the sample times as the solver passes them.
class Sampler {
 public:
  Sampler(const Program& program, const FlatDiagram& diagram, const RunOptions& options, Workspace& workspace)
      : program_(program),
        diagram_(diagram),
        options_(options),
        workspace_(workspace),
        states_(program.n_states()),
        signals_(program.n_signals()),
        row_(diagram.outputs.size() + 1) {
    std::vector<Trajectory::Column> columns{{"t", "s"}};
    for (const FlatOutput& output : diagram.outputs) columns.push_back({output.name, output.unit});
    result.trajectory = Trajectory(columns);
    result.extra = Trajectory(columns);
    result.peaks.resize(program.n_signals());
  }

  /// Adds every row up to `t`; `states_at(time, states)` gives the states within the last step.
  template <class StatesAt>
  void advance(double t, const StatesAt& states_at) {
    while (true) {
      const bool grid_left = next_sample_ < options_.samples;
      const bool extra_left = next_extra_ < options_.extra_times.size();
      const double grid_time = grid_left ? sample_time(options_, next_sample_) : options_.until + 1;
      const double extra_time = extra_left ? options_.extra_times[next_extra_] : options_.until + 1;
      const double time = std::min(grid_time, extra_time);
      if ((!grid_left && !extra_left) || time > t) return;
      states_at(time, std::span(states_));
      evaluate(time);
      if (grid_left && grid_time == time) {
        result.trajectory.add_row(row_);
        if (options_.on_sample) options_.on_sample(time, states_);
        ++next_sample_;
      }
      if (extra_left && extra_time == time) {
        result.extra.add_row(row_);
        ++next_extra_;
      }
    }
  }

  Run result;

 private:
  void evaluate(double time) {
    if (!program_.signals(time, states_.data(), signals_.data(), workspace_)) {
      throw loop_error(program_, workspace_.trouble(), time, diagram_.file);
    }
    row_[0] = time;
    for (std::size_t i = 0; i < diagram_.outputs.size(); ++i) {
      const FlatOutput& output = diagram_.outputs[i];
      row_[i + 1] = output.scale * signals_[program_.signal_index(output.signal)];
    }
    for (std::size_t s = 0; s < signals_.size(); ++s) {
      if (!std::isfinite(signals_[s])) throw_not_finite(s, time);
      if (std::abs(signals_[s]) > std::abs(result.peaks[s].value)) result.peaks[s] = {signals_[s], time};
    }
  }

  [[noreturn]] void throw_not_finite(std::size_t signal, double time) const;

  const Program& program_;
  const FlatDiagram& diagram_;
  const RunOptions& options_;
  Workspace& workspace_;
  std::vector<double> states_, signals_, row_;
  int next_sample_ = 0;
  std::size_t next_extra_ = 0;
};

void Sampler::throw_not_finite(std::size_t signal, double time) const {
  throw SolveError(SolveError::Kind::blow_up, time,
                   {{diagram_.file, {}},
                    fmt::format("the signal '{}' is not a finite number at t = {:.6g} s",
                                program_.signal_names()[signal], time),
                    {},
                    "look for a division by zero or a root or logarithm of a negative signal"});
}

}  // namespace

RunOptions options_of(const RunSettings& settings) {
  RunOptions options;
  options.until = settings.until;
  options.tolerance = settings.tolerance;
  options.method = settings.method;
  options.samples = settings.samples;
  options.max_steps = settings.max_steps;
  return options;
}

Run run(const Program& program, const FlatDiagram& diagram, const RunOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  Workspace workspace(program);
  Sampler sampler(program, diagram, options, workspace);
  std::vector<double> start = program.start();
  bring_to_rest(program, workspace, 0, start, diagram.file);
  sampler.advance(0, [&](double, std::span<double> x) { std::copy(start.begin(), start.end(), x.begin()); });
  Watch watch(program, workspace, diagram.file, options);
  watch.restart(0, start);

  if (program.n_states() == 0) {
    const double end = watch.advance_along_rows(options);
    sampler.advance(end, [](double, std::span<double>) {});
  } else {
    OperateSystem system(program, workspace);
    const MethodChoice method = choose_method(options.method, program, workspace, start);
    sampler.result.method = method;
    CvodesSolver solver(system, 0, start, options.until,
                        {options.tolerance, kAbsoluteTolerance * options.tolerance, options.max_steps,
                         method.method == IntegrationMethod::adams});
    constexpr long kStepsPerReport = 256;
    long steps = 0;
    try {
      for (double t = 0; t < options.until;) {
        t = solver.step();
        const auto states_at = [&](double time, std::span<double> x) { solver.states_at(time, x); };
        const double reached = watch.advance(t, states_at);
        sampler.advance(reached, states_at);
        if (watch.halted()) break;
        if (options.progress && ++steps % kStepsPerReport == 0) options.progress(t / options.until);
      }
    } catch (const SolverFailure& failure) {
      throw run_error(program, failure, solver, workspace, diagram.file);
    }
    sampler.result.statistics = solver.statistics();
  }
  watch.report(sampler.result);
  sampler.result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return std::move(sampler.result);
}

}  // namespace oblique
