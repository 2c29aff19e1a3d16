// SPDX-License-Identifier: MIT
// Many linkages whose lengths, or whose elements, scatter: in lanes, and in a loop of runs by CVODES.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <random>
#include <span>
#include <stdexcept>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <oblique/draw/chart/chart.h>
#include <oblique/draw/picture/svg.h>
#include <oblique/ensemble/engine/ensemble.h>
#include <oblique/ensemble/study/scatter.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/network/assembly/parameter_numbers.h>
#include <oblique/patch/patch.h>

#include "diagrams.h"
#include "figures.h"
#include "linkage_cases.h"

namespace oblique::bench {
namespace {

constexpr std::size_t kMachines = 64;   ///< that are compared; lanes run more of them, so that they are full
constexpr std::size_t kInLanes = 1024;  ///< machines in a timed run: these 64 again and again
constexpr int kRows = 73;
constexpr double kScatter = 0.005;

/// A machine's run: t and the points' coordinates, row by row.
using Table = std::vector<double>;

/// The machines of a case, as the engine and as someone with CVODES has them.
class Machines {
 public:
  Machines(const LinkageCase& chosen, bool lengths)
      : chosen_(chosen), library_(diagram::BlockLibrary::shipped()) {
    const mechanism::Mechanism mechanism = mechanism::read_mechanism(
        fmt::format("{}/diagrams/mechanisms/{}.toml", OBLIQUE_SOURCE_DIR, chosen.file));
    diagram_ = patch::patch_triangles(mechanism);
    settings_.gain = patch::PatchOptions{}.gain;
    settings_.bandwidth = patch::default_bandwidth(mechanism);
    settings_.crank_speed = chosen.crank_speed;
    settings_.scale = chosen.metres;
    settings_.until = diagram_.run.until;
    settings_.samples = kRows;
    flat_ = diagram::flatten(diagram_, library_);
    for (const std::string& point : chosen.points) {
      for (const char* axis : {".x", ".y"}) {
        const auto found = std::find_if(flat_.outputs.begin(), flat_.outputs.end(),
                                        [&](const diagram::FlatOutput& o) { return o.name == point + axis; });
        columns_.push_back(1 + static_cast<std::size_t>(found - flat_.outputs.begin()));
      }
    }
    if (lengths) {
      draw_lengths();
    } else {
      draw_elements();
    }
  }

  const HandSettings& settings() const { return settings_; }
  const std::vector<HandLinkage>& by_hand() const { return by_hand_; }
  const std::vector<std::vector<double>>& starts() const { return starts_; }
  double size() const { return chosen_.metres; }

  std::vector<Table> in_lanes(double tolerance, std::size_t count, int threads, double& seconds,
                              ensemble::EnsembleCount& counts, bool lanes = true) const {
    ensemble::EnsembleOptions options;
    options.run = solve::options_of(diagram_.run);
    options.run.samples = kRows;
    options.run.tolerance = tolerance;
    options.threads = threads;
    options.lanes = lanes;
    const ensemble::Ensemble ensemble(typical_, varied_, options);
    std::vector<Table> tables(kMachines);
    const double before = cpu_seconds();
    counts = ensemble.run(
        0, count,
        [&](std::uint64_t k, std::span<double> all) {
          std::copy(values_[k % kMachines].begin(), values_[k % kMachines].end(), all.begin());
        },
        [&](const ensemble::MachineRun& run) {
          if (run.number >= kMachines) return;
          const std::size_t width = 1 + flat_.outputs.size();
          for (std::size_t r = 0; r < run.rows.size() / width; ++r) {
            tables[run.number].push_back(run.rows[r * width]);
            for (const std::size_t column : columns_)
              tables[run.number].push_back(run.rows[r * width + column]);
          }
        });
    seconds = (cpu_seconds() - before) / static_cast<double>(count);
    return tables;
  }

  /// By the program of each machine, compiled before the time is taken, from the rest on.
  std::vector<Table> by_engine(double tolerance, double& seconds) {
    std::vector<Table> tables;
    double all = 0;
    for (CompiledDiagram& compiled : compiled_) {
      compiled.options.tolerance = tolerance;
      const TimedRun run = timed_run(compiled);
      all += run.integration;
      tables.push_back(values_of(run.run.trajectory, chosen_.points));
    }
    seconds = all / static_cast<double>(compiled_.size());
    return tables;
  }

 private:
  /// Takes the machine, whose parameters differ in numbers alone from those of the diagram.
  void add(const diagram::FlatDiagram& machine) {
    compiled_.emplace_back(machine, solve::options_of(diagram_.run));
    compiled_.back().options.samples = kRows;
  }

  void draw_lengths() {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> part(1 - kScatter, 1 + kScatter);
    std::vector<std::vector<double>> all;
    for (std::size_t k = 0; k < kMachines; ++k) {
      diagram::Diagram diagram = diagram_;
      HandLinkage& linkage = by_hand_.emplace_back(chosen_.by_hand);
      std::size_t next = 0;
      for (HandLinkage::Step& step : linkage.steps) {
        if (!step.dyad) continue;
        for (; diagram.blocks[next].type.substr(0, 8) != "dyad-rrr"; ++next) {
        }
        for (text::Entry& setting : diagram.blocks[next++].settings) {
          const double factor = part(random);
          if (setting.key == "r1") setting = diagram::number_setting("r1", step.dyad->r1 *= factor);
          if (setting.key == "r2" && !step.dyad->variable)
            setting = diagram::number_setting("r2", step.dyad->r2 *= factor);
        }
      }
      const diagram::FlatDiagram machine = diagram::flatten(diagram, library_);
      all.push_back(network::parameter_values(machine));
      add(machine);
    }
    const std::vector<double> base = network::parameter_values(flat_);
    for (std::uint32_t p = 0; p < base.size(); ++p) {
      if (std::any_of(all.begin(), all.end(), [&](const auto& one) { return one[p] != base[p]; }))
        varied_.push_back(p);
    }
    for (const std::vector<double>& one : all) {
      std::vector<double>& mine = values_.emplace_back();
      for (const std::uint32_t p : varied_) mine.push_back(one[p]);
    }
    typical_ = flat_;
    for (CompiledDiagram& compiled : compiled_) starts_.push_back(start_of(compiled));
  }

  void draw_elements() {
    const auto scatters = ensemble::scatters_of_tolerance(library_, kScatter);
    const network::ParameterNumbers numbers(flat_);
    for (const ensemble::DrawnElement& element : ensemble::drawn_elements(flat_, scatters))
      varied_.push_back(numbers.parameter(element.block, element.parameter));
    for (std::size_t k = 0; k < kMachines; ++k) {
      const auto draws = ensemble::draw(flat_, scatters, {1, k});
      std::vector<double>& mine = values_.emplace_back();
      for (const ensemble::Draw& draw : draws) mine.push_back(draw.value);
      diagram::FlatDiagram machine = flat_;
      ensemble::apply_draws(draws, machine);
      if (k == 0) typical_ = machine;
      add(machine);
    }
  }

  /// All states where the loops have come to rest.
  static std::vector<double> start_of(CompiledDiagram& compiled) {
    std::vector<double> start;
    solve::RunOptions options = compiled.options;
    options.until = 1e-6 * options.until;
    options.on_sample = [&](double, std::span<const double> states, std::span<const double>) {
      if (start.empty()) start.assign(states.begin(), states.end());
    };
    solve::run(compiled.program, compiled.flat, options);
    return start;
  }

  const LinkageCase& chosen_;
  diagram::BlockLibrary library_;
  diagram::Diagram diagram_;
  diagram::FlatDiagram flat_, typical_;
  HandSettings settings_;
  std::vector<std::size_t> columns_;
  std::vector<std::uint32_t> varied_;
  std::vector<std::vector<double>> values_, starts_;
  std::vector<HandLinkage> by_hand_;
  std::vector<CompiledDiagram> compiled_;
};

double worst(const std::vector<Table>& tables, const std::vector<Table>& truth) {
  double largest = 0;
  for (std::size_t k = 0; k < truth.size(); ++k)
    largest = std::max(largest, largest_error(tables[k], truth[k]));
  return largest;
}

/// A loop of runs by hand, with the better of two algebras.
struct Loop {
  std::vector<Table> tables;
  double seconds = 0;  ///< a run
};

Loop loop_by_hand(const Machines& machines, double tolerance, HandSolver::Algebra algebra) {
  HandSettings settings = machines.settings();
  settings.tolerance = tolerance;
  settings.absolute_tolerance = solve::kAbsoluteTolerance * tolerance;
  HandSolver solver(machines.by_hand().front(), settings, algebra);
  Loop loop;
  for (std::size_t k = 0; k < kMachines; ++k) {
    solver.use(machines.by_hand()[k]);
    HandRun run = solver.run(machines.starts()[k]);
    loop.seconds += run.seconds / kMachines;
    loop.tables.push_back(std::move(run.values));
  }
  return loop;
}

Loop best_loop_by_hand(const Machines& machines, double tolerance) {
  Loop sparse = loop_by_hand(machines, tolerance, HandSolver::Algebra::sparse);
  Loop dense = loop_by_hand(machines, tolerance, HandSolver::Algebra::dense);
  return sparse.seconds < dense.seconds ? std::move(sparse) : std::move(dense);
}

/// Time and error at one tolerance.
struct Point {
  double error, microseconds;
};

/// How long a solver takes for an error, between its points; both on logarithmic scales.
double microseconds_at(const std::vector<Point>& points, double error) {
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    const Point &a = points[k], &b = points[k + 1];
    if (!(error <= a.error && error >= b.error)) continue;
    const double part = std::log(error / a.error) / std::log(b.error / a.error);
    return a.microseconds * std::pow(b.microseconds / a.microseconds, part);
  }
  return NAN;
}

/// Where the diagrams of work and precision go: the value of OBLIQUE_BENCH_PICTURES, a folder.
void draw_work(const std::string& name, const std::string& title, const std::string& other,
               const std::vector<Point>& loop, const std::vector<Point>& lanes) {
  const char* const folder = std::getenv("OBLIQUE_BENCH_PICTURES");
  if (folder == nullptr) return;
  draw::Chart chart;
  chart.title = title;
  draw::Panel panel;
  panel.x = {"largest error, of a machine unit", "", true};
  panel.y = {"time of a run", "µs", true};
  std::size_t number = 0;
  for (const auto& [label, points] : {std::pair{other, &loop}, std::pair{std::string("lanes"), &lanes}}) {
    draw::Curve curve;
    curve.name = label;
    curve.number = number++;
    curve.style = draw::Curve::Style::dotted_line;
    for (const Point& point : *points) curve.points.emplace_back(point.error, point.microseconds);
    panel.curves.push_back(std::move(curve));
  }
  chart.panels.push_back(std::move(panel));
  std::ofstream(fmt::format("{}/work-precision-{}.svg", folder, name))
      << draw::to_svg(draw::draw_chart(chart));
}

constexpr double kTolerances[] = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9};

using Run = std::function<std::vector<Table>(double tolerance, double& seconds)>;

/// Lanes against another solver, at the same error.
void compare_at_equal_error(benchmark::State& state, const std::string& name, const std::string& title,
                            const std::string& other_name, double unit, std::span<const double> tolerances,
                            const std::vector<Table>& truth, const Run& in_lanes, const Run& other,
                            double least) {
  constexpr double kError = 1e-6;  // of a machine unit
  std::vector<double> ratios, lane_times, other_times;
  std::vector<Point> lanes, others;
  for (auto _ : state) {
    lanes.clear(), others.clear();
    for (const double tolerance : tolerances) {
      double seconds = 0;
      const auto by_other = other(tolerance, seconds);
      others.push_back({worst(by_other, truth) / unit, 1e6 * seconds});
      const auto by_lanes = in_lanes(tolerance, seconds);
      lanes.push_back({worst(by_lanes, truth) / unit, 1e6 * seconds});
    }
    lane_times.push_back(microseconds_at(lanes, kError));
    other_times.push_back(microseconds_at(others, kError));
    ratios.push_back(lane_times.back() / other_times.back());
    state.SetIterationTime(1e-6 * lane_times.back());
  }
  for (std::size_t k = 0; k < lanes.size(); ++k)
    fmt::print("  {:<18} tolerance {:.0e}   lanes {:8.1f} µs, error {:.1e}   {} {:8.1f} µs, error {:.1e}\n",
               title, tolerances[k], lanes[k].microseconds, lanes[k].error, other_name,
               others[k].microseconds, others[k].error);
  state.counters["lanes_us"] = median(lane_times);
  state.counters["other_us"] = median(other_times);
  state.counters["times_faster"] = 1 / median(ratios);
  record({fmt::format("{}: in lanes over {}, error 1e-6", title, other_name), median(ratios), 1 / least, ""});
  draw_work(name, title, other_name, others, lanes);
}

Run in_lanes(const Machines& machines) {
  return [&machines](double tolerance, double& seconds) {
    ensemble::EnsembleCount counts;
    const auto tables = machines.in_lanes(tolerance, kInLanes, 1, seconds, counts);
    if (counts.by_cvodes > 0) throw std::runtime_error("not in lanes: " + counts.reasons.begin()->first);
    return tables;
  };
}

/// Lengths scatter: beside a loop of runs by hand.
void lengths(benchmark::State& state, const LinkageCase& chosen, double least) {
  const Machines machines(chosen, true);
  compare_at_equal_error(
      state, chosen.file, chosen.title, "CVODES by hand", machines.size(), kTolerances,
      loop_by_hand(machines, 1e-12, HandSolver::Algebra::sparse).tables, in_lanes(machines),
      [&](double tolerance, double& seconds) {
        Loop loop = best_loop_by_hand(machines, tolerance);
        seconds = loop.seconds;
        return loop.tables;
      },
      least);
}

/// Weights of all elements scatter, and multipliers err: beside the engine's own runs, whose integration
/// costs what hand-written code costs (linkage_bench).
void elements(benchmark::State& state, const LinkageCase& chosen, double least) {
  Machines machines(chosen, false);
  double seconds = 0;
  compare_at_equal_error(
      state, chosen.file + "-elements", chosen.title + ", elements", "CVODES", machines.size(),
      std::span(kTolerances).subspan(1),  // the first is too coarse for some
      machines.by_engine(1e-11, seconds), in_lanes(machines),
      [&](double tolerance, double& time) { return machines.by_engine(tolerance, time); }, least);
}

/// Two threads beside one, by the wall clock: on an idle machine with two processors.
void threads(benchmark::State& state) {
  const LinkageCase chosen = class_three();
  const Machines machines(chosen, false);
  std::vector<double> ratios;
  for (auto _ : state) {
    const auto seconds_of = [&](int how_many) {
      double cpu = 0;
      ensemble::EnsembleCount counts;
      const auto before = std::chrono::steady_clock::now();
      machines.in_lanes(1e-6, 8 * kInLanes, how_many, cpu, counts);
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
    };
    const double one = seconds_of(1), two = seconds_of(2);
    state.SetIterationTime(two);
    ratios.push_back(two / one);
  }
  state.counters["times_faster"] = 1 / median(ratios);
  record({"lanes: two threads over one, class III", median(ratios), 1 / 1.8, ""});
}
BENCHMARK(threads)->Name("lanes_threads")->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(5);

const bool kLanesRegistered = [] {
  struct Asked {
    LinkageCase chosen;
    double least, least_of_elements;  ///< times faster
  };
  for (const Asked& asked : {Asked{four_bar(), 12, 12}, Asked{class_three(), 9, 9}, Asked{jansen(), 5, 5}}) {
    const auto add = [](const std::string& name, const std::function<void(benchmark::State&)>& run) {
      benchmark::RegisterBenchmark(name.c_str(), run)
          ->UseManualTime()
          ->Unit(benchmark::kMicrosecond)
          ->Iterations(3);
    };
    add("lanes_" + asked.chosen.file,
        [asked](benchmark::State& state) { lengths(state, asked.chosen, asked.least); });
    add("lanes_elements_" + asked.chosen.file,
        [asked](benchmark::State& state) { elements(state, asked.chosen, asked.least_of_elements); });
  }
  return true;
}();

}  // namespace
}  // namespace oblique::bench
