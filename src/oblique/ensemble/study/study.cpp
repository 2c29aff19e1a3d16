// SPDX-License-Identifier: MIT
#include <oblique/ensemble/study/study.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <tuple>
#include <utility>

#include <oblique/ensemble/engine/work_queue.h>
#include <oblique/ensemble/study/plan_reader.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/assembly/parameter_difference.h>
#include <oblique/network/program/program.h>

namespace oblique::ensemble {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::string first_line(const text::Diagnostic& diagnostic) {
  return diagnostic.what.substr(0, diagnostic.what.find('\n'));
}

/// Ends the runs of an ensemble from within.
struct Interrupted {};

}  // namespace

struct Study::Parts {
  Understood plan;
  std::vector<text::TableColumn> columns;
  solve::RunOptions options;
  int threads = 1;

  Machine base;  ///< whose parameters the ensemble varies
  std::vector<std::uint32_t> varied;
  std::vector<DrawnElement> drawn;
  std::vector<double> nominal;        ///< of `varied`: the values of `base`
  std::vector<std::size_t> drawn_at;  ///< of each drawn element: its place among `varied`
  /// Where each varied name is one parameter or weight: its place among `varied`; else machines are made one
  /// by one. Of a mechanism only where nothing but its elements changes.
  std::optional<std::vector<std::size_t>> direct;
  std::optional<Ensemble> ensemble;

  void choose_numbers();
  std::vector<std::uint32_t> changed_by(std::size_t name) const;
  DrawKey key_of(std::uint64_t number) const { return {plan.seed, plan.combinations.draw_number(number)}; }
  std::vector<double> values_of(std::uint64_t number) const {
    std::vector<double> values(plan.names.size());
    plan.combinations.values(number, values);
    return values;
  }
  StudyRow row_of(std::uint64_t number) const {
    StudyRow row;
    row.number = number;
    row.values = values_of(number);
    row.values.resize(columns.size(), kNone);
    return row;
  }
  /// Gives by what part of their size the measures may err because of few rows.
  double measure(const MachineRun& run, const Machine& machine, StudyRow& row) const;

  /// Rows that were done, and by what.
  struct Table {
    std::vector<StudyRow> rows;
    std::vector<char> done;
    std::mutex guard;
    EnsembleCount count;

    void finish(std::size_t at, const std::string& no_lane, const std::string& warning, double doubt) {
      const std::lock_guard lock(guard);
      done[at] = 1;
      ++(no_lane.empty() ? count.in_lanes : count.by_cvodes);
      if (!no_lane.empty()) ++count.reasons[no_lane];
      if (!rows[at].failure.empty()) ++count.failed;
      if (!warning.empty()) count.warn(rows[at].number, warning);
      count.measured(doubt);
    }
  };
  void run_directly(std::uint64_t first, std::uint64_t count, Table& table,
                    const Ensemble::Progress& progress) const;
  void run_made(std::uint64_t first, std::uint64_t count, Table& table,
                const Ensemble::Progress& progress) const;
  /// A machine that was made one by one, before it is run.
  struct Made {
    std::size_t at = 0;  ///< its place in the table
    Machine machine;
    bool alike = false;          ///< it differs from `base` in `varied` alone
    std::vector<double> values;  ///< of `varied`
  };
  Made make(std::uint64_t number) const;
  /// Gives its warning, and what `measure` gives.
  std::pair<std::string, double> run_alone(Made& made, StudyRow& row) const;
};

/// The parameters that a varied name changes on its way to its bounds. A mechanism need not reach them: then
/// half of the way counts, or half of that.
std::vector<std::uint32_t> Study::Parts::changed_by(std::size_t name) const {
  constexpr int kHalvings = 5;
  const network::ParameterNumbers numbers(base.flat);
  std::vector<std::uint32_t> all;
  for (const double bound : {plan.lowest[name], plan.highest[name]}) {
    double way = bound - plan.usual[name];
    for (int k = 0; k < kHalvings && way != 0; ++k, way /= 2) {
      std::vector<double> values = plan.usual;
      values[name] = k == 0 ? bound : plan.usual[name] + way;
      try {
        const auto changed =
            network::parameter_difference(base.flat, numbers, plan.subject->machine(values).flat);
        if (!changed) continue;
        for (const std::uint32_t one : *changed) {
          if (std::find(all.begin(), all.end(), one) == all.end()) all.push_back(one);
        }
        break;
      } catch (const text::Error&) {  // of a mechanism that cannot be: a row with its reason
      }
    }
  }
  return all;
}

/// Finds the parameters that machines differ in, from what the bounds of the varied names do to the diagram:
/// the same for every chunk of a plan.
void Study::Parts::choose_numbers() {
  base = plan.subject->machine(plan.usual);
  const network::ParameterNumbers numbers(base.flat);
  const auto add = [&](std::uint32_t number) {
    const auto found = std::find(varied.begin(), varied.end(), number);
    if (found == varied.end()) varied.push_back(number);
    return static_cast<std::size_t>(std::find(varied.begin(), varied.end(), number) - varied.begin());
  };
  if (!plan.mechanism || plan.names.empty()) direct.emplace();
  for (std::size_t k = 0; k < plan.names.size(); ++k) {
    const std::vector<std::uint32_t> changed = changed_by(k);
    for (const std::uint32_t number : changed) add(number);
    if (!direct) continue;
    const auto one = network::find_parameter(base.flat, numbers, plan.names[k]);
    const bool is_one =
        one && one->value == plan.usual[k] &&
        (plan.lowest[k] == plan.highest[k] || changed == std::vector<std::uint32_t>{one->number});
    if (is_one) {
      direct->push_back(add(one->number));
    } else {
      direct.reset();
    }
  }
  for (const DrawnElement& element : drawn_elements(base.flat, plan.scatters)) {
    drawn.push_back(element);
    drawn_at.push_back(add(numbers.parameter(element.block, element.parameter)));
  }
  const std::vector<double> all = network::parameter_values(base.flat);
  for (const std::uint32_t number : varied) nominal.push_back(all[number]);
}

double Study::Parts::measure(const MachineRun& run, const Machine& machine, StudyRow& row) const {
  if (!run.failure.empty()) {
    row.failure = run.failure;
    return 0;
  }
  const std::size_t n = 1 + machine.flat.outputs.size(), n_rows = run.rows.size() / n;
  std::vector<std::vector<double>> outputs(n, std::vector<double>(n_rows));
  for (std::size_t c = 0; c < n; ++c) {
    const double scale = c == 0 ? 1 : machine.flat.outputs[c - 1].scale;
    const double offset = c == 0 ? 0 : machine.flat.outputs[c - 1].offset;
    for (std::size_t r = 0; r < n_rows; ++r) outputs[c][r] = scale * run.rows[r * n + c] + offset;
  }
  const MotionErrors errors = plan.asks_for_errors ? machine.errors(outputs) : MotionErrors{};
  std::vector<std::vector<double>> table{outputs[0]};
  for (const MeasuredColumn& column : plan.measured) {
    table.push_back(column.exact.empty() ? outputs[1 + column.output] : machine.exact(column.exact, n_rows));
  }
  const SampledRun sampled(std::move(table));
  for (std::size_t k = 0; k < plan.measures.size(); ++k)
    row.values[plan.names.size() + k] = plan.measures[k].value(sampled, errors);
  return sampled.doubt();
}

void Study::Parts::run_directly(std::uint64_t first, std::uint64_t count, Table& table,
                                const Ensemble::Progress& progress) const {
  const auto values = [&](std::uint64_t number, std::span<double> all) {
    std::copy(nominal.begin(), nominal.end(), all.begin());
    const std::vector<double> chosen = values_of(number);
    for (std::size_t k = 0; k < chosen.size(); ++k) all[(*direct)[k]] = chosen[k];
    const std::vector<double> about(all.begin(), all.end());
    for (std::size_t k = 0; k < drawn.size(); ++k)
      all[drawn_at[k]] = drawn[k].draw(base.flat, about[drawn_at[k]], key_of(number));
  };
  const auto take = [&](const MachineRun& run) {
    const auto at = static_cast<std::size_t>(run.number - first);
    const double doubt = measure(run, base, table.rows[at]);
    table.finish(at, run.no_lane, run.warning, doubt);
  };
  ensemble->run(first, count, values, take, progress);
}

Study::Parts::Made Study::Parts::make(std::uint64_t number) const {
  Made made;
  made.machine = plan.subject->machine(values_of(number));
  const network::ParameterNumbers numbers(made.machine.flat);
  std::vector<Draw> draws;
  for (const DrawnElement& element : drawn_elements(made.machine.flat, plan.scatters)) {
    const double about = made.machine.flat.blocks[element.block].parameters[element.parameter];
    draws.push_back(
        {element.block, element.parameter, element.draw(made.machine.flat, about, key_of(number))});
  }
  apply_draws(draws, made.machine.flat);
  const auto changed =
      network::parameter_difference(base.flat, network::ParameterNumbers(base.flat), made.machine.flat);
  const bool is_alike = changed && made.machine.until == base.until &&
                        std::all_of(changed->begin(), changed->end(), [&](std::uint32_t one) {
                          return std::find(varied.begin(), varied.end(), one) != varied.end();
                        });
  made.alike = is_alike;
  if (!is_alike) return made;
  const std::vector<double> all = network::parameter_values(made.machine.flat);
  for (const std::uint32_t one : varied) made.values.push_back(all[one]);
  return made;
}

std::pair<std::string, double> Study::Parts::run_alone(Made& made, StudyRow& row) const {
  diagram::FlatDiagram flat = made.machine.flat;
  for (diagram::FlatOutput& output : flat.outputs) {
    output.scale = 1;
    output.offset = 0;
  }
  MachineRun done;
  solve::Run run;
  try {
    solve::RunOptions how = options;
    how.until = made.machine.until;
    run = solve::run(network::Program(network::assemble(flat)), flat, how);
    done.rows = run.trajectory.values();
    if (!run.warnings.empty()) done.warning = first_line(run.warnings.front());
  } catch (const text::Error& error) {
    done.failure = first_line(error.diagnostics().front());
  }
  const double doubt = measure(done, made.machine, row);
  return {done.warning, doubt};
}

void Study::Parts::run_made(std::uint64_t first, std::uint64_t count, Table& table,
                            const Ensemble::Progress& progress) const {
  constexpr std::uint64_t kBatch = 1024;  // that are held at a time
  for (std::uint64_t begin = 0; begin < count; begin += kBatch) {
    const std::uint64_t n = std::min(kBatch, count - begin);
    std::vector<Made> alike;
    std::mutex guard;
    work_off(
        begin, n, threads,
        [&](const Next& next) {
          for (std::uint64_t at = 0; next(at);) {
            StudyRow& row = table.rows[at];
            std::string warning;
            double doubt = 0;
            try {
              Made made = make(first + at);
              made.at = at;
              if (made.alike) {
                const std::lock_guard lock(guard);
                alike.push_back(std::move(made));
                continue;
              }
              std::tie(warning, doubt) = run_alone(made, row);
            } catch (const text::Error& error) {
              row.failure = first_line(error.diagnostics().front());
            }
            table.finish(
                at, row.failure.empty() ? "its diagram differs in more than numbers" : "it cannot be made",
                warning, doubt);
          }
        },
        [&](std::uint64_t) {
          if (progress) progress(begin);
        });
    std::sort(alike.begin(), alike.end(), [](const Made& a, const Made& b) { return a.at < b.at; });
    ensemble->run(
        0, alike.size(),
        [&](std::uint64_t k, std::span<double> all) {
          std::copy(alike[k].values.begin(), alike[k].values.end(), all.begin());
        },
        [&](const MachineRun& run) {
          const Made& made = alike[run.number];
          const double doubt = measure(run, made.machine, table.rows[made.at]);
          table.finish(made.at, run.no_lane, run.warning, doubt);
        },
        [&](std::uint64_t done) {
          if (progress) progress(begin + (n - alike.size()) + done);
        });
  }
}

Study::Study(const Plan& plan, const std::string& text, const diagram::BlockLibrary& library, int threads) {
  auto parts = std::make_unique<Parts>();
  parts->plan = understand(plan, text, library);
  parts->threads = std::max(threads, 1);
  for (std::size_t k = 0; k < parts->plan.names.size(); ++k) {
    const std::string& unit = parts->plan.units[k];
    parts->columns.push_back({parts->plan.names[k], unit == "1" ? "" : unit});
  }
  for (const std::string& name : parts->plan.measure_names) parts->columns.push_back({name});
  for (std::size_t k = 0; k < parts->plan.measures.size(); ++k) {
    if (parts->plan.measures[k].is_distance())
      parts->columns[parts->plan.names.size() + k].unit = parts->plan.subject->length_unit();
  }
  parts->options = parts->plan.subject->run_options();
  if (plan.tolerance) parts->options.tolerance = *plan.tolerance;
  if (plan.samples) parts->options.samples = *plan.samples;
  parts->choose_numbers();
  parts->options.until = parts->base.until;
  EnsembleOptions options;
  options.run = parts->options;
  options.threads = parts->threads;
  // A machine that draws: elements that scatter may be other cases of their equations than ideal ones.
  diagram::FlatDiagram flat = parts->base.flat;
  apply_draws(draw(flat, parts->plan.scatters, {parts->plan.seed, 0}), flat);
  for (diagram::FlatOutput& output : flat.outputs) {
    output.scale = 1;
    output.offset = 0;
  }
  parts->ensemble.emplace(std::move(flat), parts->varied, std::move(options));
  parts_ = std::move(parts);
}

Study::~Study() = default;
Study::Study(Study&&) noexcept = default;

const std::string& Study::title() const {
  return parts_->plan.subject->diagram().title;
}

std::uint64_t Study::runs() const {
  return parts_->plan.combinations.runs();
}

const std::vector<text::TableColumn>& Study::columns() const {
  return parts_->columns;
}

std::size_t Study::n_varied() const {
  return parts_->plan.names.size();
}

bool Study::is_logarithmic(std::size_t varied) const {
  return parts_->plan.logarithmic[varied];
}

std::size_t Study::n_drawn() const {
  return parts_->drawn.size();
}

const solve::RunOptions& Study::run_options() const {
  return parts_->options;
}

Study::Rows Study::run(std::uint64_t first, std::uint64_t count, const Ensemble::Progress& progress,
                       const std::function<bool()>& interrupted) const {
  Parts::Table table;
  table.done.resize(count);
  for (std::uint64_t k = 0; k < count; ++k) table.rows.push_back(parts_->row_of(first + k));
  const auto watch = [&](std::uint64_t done) {
    if (interrupted && interrupted()) throw Interrupted();
    if (progress) progress(done);
  };
  try {
    if (parts_->direct) {
      parts_->run_directly(first, count, table, watch);
    } else {
      parts_->run_made(first, count, table, watch);
    }
  } catch (const Interrupted&) {
  }
  Rows done;
  for (std::size_t k = 0; k < table.rows.size(); ++k) {
    if (table.done[k] != 0) done.rows.push_back(std::move(table.rows[k]));
  }
  done.count = std::move(table.count);
  return done;
}

}  // namespace oblique::ensemble
