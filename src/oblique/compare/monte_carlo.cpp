// SPDX-License-Identifier: MIT
#include <oblique/compare/monte_carlo.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>

#include <oblique/compare/patched_run.h>
#include <oblique/diagram/flatten.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/assembly/parameter_numbers.h>
#include <oblique/network/program/program.h>

namespace oblique::compare {
namespace {

constexpr double kFinerThanScatter = 1e-3;
constexpr double kCoarsest = 1e-6, kFinest = 1e-10;  ///< of the solver's tolerance

double tolerance_for(const std::vector<diagram::BlockFigure>& scatters) {
  double narrowest = 1;
  for (const diagram::BlockFigure& scatter : scatters) {
    if (scatter.value > 0) narrowest = std::min(narrowest, scatter.value);
  }
  return std::clamp(kFinerThanScatter * narrowest, kFinest, kCoarsest);
}

/// Runs machines by their numbers, at the tolerance of the options or finer ones, and measures them.
class Experiment {
 public:
  /// Finds how far the rows of a run are from where they should be.
  using Measure = std::function<Distances(std::span<const double> rows)>;

  Experiment(const MonteCarloOptions& options, diagram::FlatDiagram flat, solve::RunOptions how,
             Measure measure)
      : options_(options),
        flat_(std::move(flat)),
        elements_(ensemble::drawn_elements(flat_, options.scatters)),
        how_(std::move(how)),
        measure_(std::move(measure)) {
    const network::ParameterNumbers numbers(flat_);
    const std::vector<double> all = network::parameter_values(flat_);
    for (const ensemble::DrawnElement& element : elements_) {
      const std::uint32_t number = numbers.parameter(element.block, element.parameter);
      const auto known = std::find(varied_.begin(), varied_.end(), number);
      places_.push_back(static_cast<std::size_t>(known - varied_.begin()));
      if (known != varied_.end()) continue;  // of two scatters of one parameter the last one counts
      varied_.push_back(number);
      nominal_.push_back(all[number]);
    }
    typical_ = flat_;
    ensemble::apply_draws(ensemble::draw(flat_, options.scatters, {options.seed, 0}), typical_);
    ensemble_.emplace(typical_, varied_, options_of(how_.tolerance));
  }

  std::size_t drawn() const { return elements_.size(); }

  /// Runs `count` machines of the experiment from its k-th on. At a coarse tolerance the solver may find no
  /// step in a stiff loop that a finer one passes: a run that fails is tried again, ten and a hundred times
  /// finer.
  void run(std::size_t first, std::size_t count, MonteCarlo& result,
           const std::function<void(std::uint64_t)>& progress) const {
    std::vector<std::size_t> places(count);
    std::iota(places.begin(), places.end(), first);
    std::vector<FailedRun> failed;
    run(*ensemble_, places, result, failed, &result.count, progress);
    double tolerance = how_.tolerance;
    for (int attempt = 0; attempt < 2 && !failed.empty(); ++attempt) {
      tolerance /= 10;
      places.clear();
      for (const FailedRun& one : failed)
        places.push_back(static_cast<std::size_t>(one.number - options_.first_run));
      failed.clear();
      run(ensemble::Ensemble(typical_, varied_, options_of(tolerance)), places, result, failed, nullptr, {});
    }
    result.count.failed += failed.size();
    result.failures.insert(result.failures.end(), failed.begin(), failed.end());
  }

 private:
  ensemble::EnsembleOptions options_of(double tolerance) const {
    ensemble::EnsembleOptions options;
    options.run = how_;
    options.run.tolerance = tolerance;
    options.threads = options_.threads;
    return options;
  }

  void run(const ensemble::Ensemble& ensemble, const std::vector<std::size_t>& places, MonteCarlo& result,
           std::vector<FailedRun>& failed, ensemble::EnsembleCount* count,
           const std::function<void(std::uint64_t)>& progress) const {
    std::vector<std::string> failures(places.size());
    const auto values = [&](std::uint64_t k, std::span<double> drawn) {
      const ensemble::DrawKey key{options_.seed, options_.first_run + places[k]};
      std::copy(nominal_.begin(), nominal_.end(), drawn.begin());
      for (std::size_t e = 0; e < elements_.size(); ++e)
        drawn[places_[e]] = elements_[e].draw(flat_, nominal_[places_[e]], key);
    };
    const auto take = [&](const ensemble::MachineRun& run) {
      const std::size_t place = places[run.number];
      failures[run.number] = run.failure;
      if (!run.failure.empty()) return;
      Distances found = measure_(run.rows);
      result.errors[place] = found.largest;
      if (place < result.along.size()) result.along[place] = std::move(found.along);
    };
    const ensemble::EnsembleCount done = ensemble.run(0, places.size(), values, take, progress);
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (!failures[k].empty()) failed.push_back({options_.first_run + places[k], failures[k]});
    }
    if (count == nullptr) return;
    const std::uint64_t failures_known = count->failed;  // of the last attempt, counted by the caller
    *count += done;
    count->failed = failures_known;
  }

  const MonteCarloOptions& options_;
  diagram::FlatDiagram flat_;     ///< undisturbed
  diagram::FlatDiagram typical_;  ///< a machine that draws, with the cases of equations that this chooses
  std::vector<ensemble::DrawnElement> elements_;
  std::vector<std::uint32_t> varied_;
  std::vector<double> nominal_;
  std::vector<std::size_t> places_;  ///< of each element among `varied_`
  solve::RunOptions how_;
  Measure measure_;
  std::optional<ensemble::Ensemble> ensemble_;
};

/// How many of the first runs are good.
Yield yield_of_first(const MonteCarlo& result, std::size_t runs, double good_below) {
  const auto end = result.errors.begin() + static_cast<std::ptrdiff_t>(runs);
  const auto good = std::count_if(result.errors.begin(), end, [&](const std::optional<double>& error) {
    return error && *error < good_below;
  });
  return yield_of(static_cast<std::uint64_t>(good), runs);
}

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

namespace {

/// `measure_of` gives what measures the rows of the flat diagram.
template <class MeasureOf>
MonteCarlo draw_machines(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                         const MonteCarloOptions& options, std::vector<double> drive,
                         const MeasureOf& measure_of) {
  constexpr std::size_t kBatch = 100;  // between two looks at the yield
  const diagram::FlatDiagram flat = diagram::flatten(diagram, library);
  solve::RunOptions how = solve::options_of(diagram.run);
  how.samples = static_cast<int>(drive.size());
  how.tolerance = tolerance_for(options.scatters);
  const solve::Run undisturbed = solve::run(network::Program(network::assemble(flat)), flat, how);
  how.max_steps = kStepsOfAFailure * std::max(undisturbed.statistics.steps, std::int64_t{1});
  const Experiment experiment(options, flat, how, measure_of(flat));

  const auto runs = static_cast<std::size_t>(options.runs);
  MonteCarlo result;
  result.drawn = experiment.drawn();
  result.tolerance = how.tolerance;
  result.errors.resize(runs);
  result.along.resize(std::min(runs, MonteCarlo::kMostAlong));
  result.drive = std::move(drive);
  const bool looks = options.good_below && options.until_within;
  std::size_t done = 0;
  while (done < runs) {
    const std::size_t count = looks ? std::min(kBatch, runs - done) : runs - done;
    experiment.run(done, count, result, [&](std::uint64_t k) {
      if (options.progress)
        options.progress((static_cast<double>(done) + static_cast<double>(k)) / static_cast<double>(runs));
    });
    done += count;
    if (options.good_below) result.yield = yield_of_first(result, done, *options.good_below);
    if (looks && (result.yield->high - result.yield->low) / 2 <= *options.until_within) break;
  }
  result.errors.resize(done);
  result.along.resize(std::min(done, result.along.size()));
  const auto worst =
      std::max_element(result.errors.begin(), result.errors.end());  // nothing is below all values
  if (worst != result.errors.end() && *worst)
    result.worst_run = options.first_run + static_cast<std::uint64_t>(worst - result.errors.begin());
  return result;
}

}  // namespace

MonteCarlo monte_carlo(const mechanism::Mechanism& whole, const diagram::Diagram& diagram,
                       const diagram::BlockLibrary& library, const MonteCarloOptions& options) {
  const mechanism::Mechanism mechanism = patch::within_range(whole);
  const mechanism::Motion exact =
      mechanism::solve_motion(mechanism, mechanism::rows_over_motion(mechanism, options.positions));
  std::vector<double> drive;
  for (const auto& drives : exact.drives) drive.push_back(drives.front().value);
  return draw_machines(diagram, library, options, std::move(drive), [&](const diagram::FlatDiagram& flat) {
    return [points = point_outputs(mechanism, flat), columns = 1 + flat.outputs.size(),
            &exact](std::span<const double> rows) { return distances(points, rows, columns, exact); };
  });
}

MonteCarlo monte_carlo(const solve::Trajectory& reference, const diagram::Diagram& diagram,
                       const diagram::BlockLibrary& library, const MonteCarloOptions& options) {
  std::vector<double> times;
  for (std::size_t row = 0; row < reference.rows(); ++row) times.push_back(reference.at(row, 0));
  return draw_machines(diagram, library, options, std::move(times), [&](const diagram::FlatDiagram&) {
    return [&](std::span<const double> rows) { return relative_distances(rows, reference); };
  });
}

}  // namespace oblique::compare
