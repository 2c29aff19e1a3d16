// SPDX-License-Identifier: MIT
#include <oblique/compare/monte_carlo.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <system_error>
#include <thread>

#include <oblique/compare/patched_run.h>
#include <oblique/diagram/flatten.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/solve_error.h>

namespace oblique::compare {
namespace {

constexpr double kFinerThanScatter = 1e-3;
constexpr double kCoarsest = 1e-6, kFinest = 1e-10;  ///< of the solver's tolerance
constexpr long kStepsOfAFailure = 100;               ///< times those of the undisturbed run

double tolerance_for(const std::vector<diagram::BlockFigure>& scatters) {
  double narrowest = 1;
  for (const diagram::BlockFigure& scatter : scatters) {
    if (scatter.value > 0) narrowest = std::min(narrowest, scatter.value);
  }
  return std::clamp(kFinerThanScatter * narrowest, kFinest, kCoarsest);
}

/// What the runs have in common; nothing in it changes while they go on.
struct Experiment {
  const mechanism::Mechanism& mechanism;
  const MonteCarloOptions& options;
  diagram::FlatDiagram flat;
  mechanism::Motion exact;
  solve::RunOptions how;

  /// At a coarse tolerance the solver may find no step in a stiff loop that a finer one passes: such a run is
  /// tried again, ten and a hundred times finer.
  Distances errors_of(const diagram::FlatDiagram& diagram) const {
    const network::Program program(network::assemble(diagram));
    solve::RunOptions finer = how;
    for (int attempt = 0; attempt < 2; ++attempt) {
      try {
        return distances(mechanism, diagram, solve::run(program, diagram, finer).trajectory, exact);
      } catch (const solve::SolveError&) {
        finer.tolerance /= 10;
      }
    }
    return distances(mechanism, diagram, solve::run(program, diagram, finer).trajectory, exact);
  }
};

/// One run after the other until none is left, in as many threads as call this.
class Queue {
 public:
  Queue(const Experiment& experiment, MonteCarlo& result)
      : experiment_(experiment), result_(result), messages_(result.errors.size()) {}

  /// `watch` is called after every run with the part that is done.
  void work(const std::function<void(double)>& watch) {
    const std::size_t runs = result_.errors.size();
    for (std::size_t k = next_++; k < runs; k = next_++) {
      try {
        serve(k);
        if (watch) watch(static_cast<double>(std::min(next_.load(), runs)) / static_cast<double>(runs));
      } catch (
          ...) {  // no finding about this run: out of memory, a fault of the program, a caller who ends it
        if (!broken_.exchange(true)) exception_ = std::current_exception();
        next_ = runs;
      }
    }
  }

  /// Call it when all threads have come back.
  void finish() {
    if (exception_) std::rethrow_exception(exception_);
    for (std::size_t k = 0; k < messages_.size(); ++k) {
      const std::uint64_t number = experiment_.options.first_run + k;
      if (!result_.errors[k]) result_.failures.push_back({number, messages_[k]});
    }
  }

 private:
  void serve(std::size_t k) {
    const MonteCarloOptions& options = experiment_.options;
    diagram::FlatDiagram diagram = experiment_.flat;
    ensemble::apply_draws(ensemble::draw(diagram, options.scatters, {options.seed, options.first_run + k}),
                          diagram);
    try {
      Distances found = experiment_.errors_of(diagram);
      result_.errors[k] = found.largest;
      if (k < result_.along.size()) result_.along[k] = std::move(found.along);
    } catch (const text::Error& error) {
      const std::string& what = error.diagnostics().front().what;
      messages_[k] = what.substr(0, what.find('\n'));
    }
  }

  const Experiment& experiment_;
  MonteCarlo& result_;
  std::vector<std::string> messages_;  ///< of failed runs
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> broken_ = false;
  std::exception_ptr exception_;
};

/// The one of `values`, of which there is at least one, that `percent` of them do not exceed.
double nearest_rank(std::vector<double> values, double percent) {
  const double rank = std::ceil(percent / 100 * static_cast<double>(values.size()));
  const auto place = std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(rank) - 1, 0,
                                                static_cast<std::ptrdiff_t>(values.size()) - 1);
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<std::size_t>(place)];
}

}  // namespace

std::optional<double> MonteCarlo::percentile(double percent) const {
  std::vector<double> known;
  for (const std::optional<double>& error : errors) {
    if (error) known.push_back(*error);
  }
  if (known.empty()) return std::nullopt;
  return nearest_rank(std::move(known), percent);
}

std::vector<double> MonteCarlo::percentile_along(double percent) const {
  std::vector<double> percentiles;
  for (std::size_t row = 0; row < drive.size(); ++row) {
    std::vector<double> known;
    for (const std::vector<double>& run : along) {
      if (!run.empty()) known.push_back(run[row]);
    }
    if (known.empty()) return {};
    percentiles.push_back(nearest_rank(std::move(known), percent));
  }
  return percentiles;
}

MonteCarlo monte_carlo(const mechanism::Mechanism& whole, const diagram::Diagram& diagram,
                       const diagram::BlockLibrary& library, const MonteCarloOptions& options) {
  const mechanism::Mechanism mechanism = patch::within_range(whole);
  Experiment experiment{mechanism, options, diagram::flatten(diagram, library),
                        mechanism::solve_motion(mechanism, options.positions),
                        solve::options_of(diagram.run)};
  experiment.how.samples = options.positions;
  experiment.how.tolerance = tolerance_for(options.scatters);
  const solve::Run undisturbed =
      solve::run(network::Program(network::assemble(experiment.flat)), experiment.flat, experiment.how);
  experiment.how.max_steps = kStepsOfAFailure * std::max(undisturbed.statistics.steps, 1L);

  MonteCarlo result;
  result.drawn = ensemble::draw(experiment.flat, options.scatters, {}).size();
  result.tolerance = experiment.how.tolerance;
  result.errors.resize(static_cast<std::size_t>(options.runs));
  result.along.resize(std::min(result.errors.size(), MonteCarlo::kMostAlong));
  for (const auto& drives : experiment.exact.drives) result.drive.push_back(drives.front().value);
  Queue queue(experiment, result);
  {
    std::vector<std::jthread> others;
    try {
      for (int t = 1; t < std::min(options.threads, options.runs); ++t)
        others.emplace_back([&queue] { queue.work({}); });
    } catch (const std::system_error&) {  // no more threads to be had: those there are do the work
    }
    queue.work(options.progress);
  }
  queue.finish();
  const auto worst =
      std::max_element(result.errors.begin(), result.errors.end());  // nothing is below all values
  if (worst != result.errors.end() && *worst)
    result.worst_run = options.first_run + static_cast<std::uint64_t>(worst - result.errors.begin());
  return result;
}

}  // namespace oblique::compare
