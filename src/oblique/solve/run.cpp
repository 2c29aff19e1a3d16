// SPDX-License-Identifier: MIT
#include <oblique/solve/run.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include <oblique/solve/rest.h>
#include <oblique/solve/solve_error.h>

namespace oblique {
namespace {

/// Collects rows at the sample times as the solver passes them.
class Sampler {
 public:
  Sampler(const Program& program, const FlatDiagram& diagram, const RunOptions& options, Workspace& workspace,
          Switching& switching)
      : program_(program),
        diagram_(diagram),
        options_(options),
        workspace_(workspace),
        switching_(switching),
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
      const double grid_time = grid_left ? sample_time(next_sample_) : options_.until + 1;
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
  double sample_time(int k) const {
    return k + 1 == options_.samples ? options_.until : options_.until * k / (options_.samples - 1);
  }

  void evaluate(double time) {
    switching_.place_sliding(time, states_);
    if (!program_.signals(time, states_.data(), signals_.data(), workspace_)) {
      throw loop_error(program_, workspace_.trouble(), time, diagram_.file);
    }
    row_[0] = time;
    for (std::size_t i = 0; i < diagram_.outputs.size(); ++i) {
      const FlatOutput& output = diagram_.outputs[i];
      row_[i + 1] = output.scale * signals_[program_.signal_index(output.signal)] + output.offset;
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
  Switching& switching_;
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

namespace {

/// A diagram in the mode "operate", with its switches.
class OperateSystem final : public OdeSystem {
 public:
  OperateSystem(const Program& program, Switching& switching) : program_(program), switching_(switching) {}
  std::size_t size() const override { return program_.n_states(); }
  const SparsePattern& pattern() const override { return program_.jacobian_pattern(); }
  bool derivatives(double t, const double* x, double* dxdt) override {
    return switching_.derivatives(t, x, dxdt);
  }
  bool jacobian(double t, const double* x, double* values) override {
    return switching_.jacobian(t, x, values);
  }

 private:
  const Program& program_;
  Switching& switching_;
};

/// One run from its start to its end: smooth stretches, and events between them.
class Runner {
 public:
  Runner(const Program& program, const FlatDiagram& diagram, const RunOptions& options)
      : program_(program),
        diagram_(diagram),
        options_(options),
        workspace_(program),
        switching_(program, workspace_, options.until, diagram.file),
        system_(program, switching_),
        sampler_(program, diagram, options, workspace_, switching_),
        states_(program.start()) {}

  Run run() {
    switching_.start(0, states_, [&] { bring_to_rest(program_, workspace_, 0, states_, diagram_.file); });
    sampler_.advance(
        0, [&](double, std::span<double> x) { std::copy(states_.begin(), states_.end(), x.begin()); });
    if (program_.n_states() > 0) {
      integrate();
    } else {
      follow();
    }
    sampler_.result.events = switching_.records();
    sampler_.result.event_count = switching_.count();
    return std::move(sampler_.result);
  }

 private:
  /// The end of a smooth stretch that begins at t; settles what turns over at t itself.
  double stretch_end(double t) {
    if (!switching_.active()) return options_.until;
    double end = switching_.next_known_time(t, states_);
    while (!(end > t + kShortest * t)) {
      switching_.settle(t, states_);
      end = switching_.next_known_time(t, states_);
    }
    return std::min(end, options_.until);
  }

  /// Samples the step that ends at t and settles an event in it; the time from which to go on, which is t
  /// where the stretch goes on.
  template <class InStep>
  bool finish_step(double from, double& t, double stretch_end, const InStep& states_at) {
    std::optional<double> event;
    if (switching_.active()) event = switching_.search(from, t, states_at);
    const bool ends = event || (t >= stretch_end && t < options_.until);
    if (event) t = *event;
    sampler_.advance(t, states_at);
    if (!ends || t >= options_.until) return false;
    states_at(t, states_);
    switching_.settle(t, states_);
    return true;
  }

  void integrate() {
    const MethodChoice method = choose_method(options_.method, program_, workspace_, states_, options_.until);
    sampler_.result.method = method;
    double t = 0;
    double end = stretch_end(t);
    CvodesSolver solver(system_, t, states_, end,
                        {options_.tolerance, kAbsoluteTolerance * options_.tolerance, options_.max_steps,
                         method.method == IntegrationMethod::adams});
    const StatesAt states_at = [&](double time, std::span<double> x) { solver.states_at(time, x); };
    constexpr long kStepsPerReport = 256;
    long steps = 0;
    try {
      while (t < options_.until) {
        const double from = t;
        t = solver.step();
        if (finish_step(from, t, end, states_at)) {
          end = stretch_end(t);
          solver.restart(t, states_, end);
        }
        if (options_.progress && ++steps % kStepsPerReport == 0) options_.progress(t / options_.until);
      }
    } catch (const SolverFailure& failure) {
      throw run_error(program_, failure, solver, workspace_, diagram_.file);
    }
    sampler_.result.statistics = solver.statistics();
  }

  /// A diagram without states follows the time alone: steps as long as the rows are apart.
  void follow() {
    const StatesAt no_states = [](double, std::span<double>) {};
    const double step = options_.until / (options_.samples - 1);
    double t = 0;
    double end = stretch_end(t);
    while (t < options_.until) {
      const double from = t;
      t = std::min(end, t + step);
      if (end - t < kShortest * end) t = end;
      if (finish_step(from, t, end, no_states)) end = stretch_end(t);
    }
  }

  static constexpr double kShortest = 1e-15;  ///< of the time: the clock cannot show less

  const Program& program_;
  const FlatDiagram& diagram_;
  const RunOptions& options_;
  Workspace workspace_;
  Switching switching_;
  OperateSystem system_;
  Sampler sampler_;
  std::vector<double> states_;
};

}  // namespace

Run run(const Program& program, const FlatDiagram& diagram, const RunOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  Run result = Runner(program, diagram, options).run();
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace oblique
