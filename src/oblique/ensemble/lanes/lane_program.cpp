// SPDX-License-Identifier: MIT
#include <oblique/ensemble/lanes/lane_program.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <unordered_map>

#include <fmt/format.h>

#include <oblique/ensemble/lanes/lane_array.h>
#include <oblique/ensemble/lanes/lane_kernels.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/assembly/parameter_numbers.h>
#include <oblique/network/program/flat_equations.h>
#include <oblique/solve/integrator/rosenbrock.h>
#include <oblique/solve/operating_point/rest.h>
#include <oblique/solve/solve_error.h>

namespace oblique::ensemble {
namespace {

constexpr std::size_t kMostVariables = 300;
constexpr std::size_t kMostSamples = 6;  ///< moments of the run by CVODES at which the matrix is looked at
/// Of the run's tolerance: what a method errs by in a step adds up, and is more where it is stiff. So that
/// results err no more than those of CVODES, over all shipped diagrams.
constexpr double kTighterRosenbrock = 10, kTighterVerner = 30;
constexpr std::size_t kStepsOfAFailure = 100;  ///< times those of the diagram as it is, and some
constexpr std::size_t kStepsAlways = 10'000;

/// Why a program is not for lanes; empty where it is.
std::string obstacle(const network::Program& program) {
  if (program.n_states() == 0) return "the diagram has no states";
  if (!program.discrete_states().empty() || !program.switches().empty() || !program.events().empty())
    return "the diagram has switches or events";
  if (!program.turning_rate_slots()) return "a function of the time or of states may hide a peak in a step";
  return {};
}

/// With all signals as outputs, behind those asked for, where lanes can have them: so that they see what a
/// run by CVODES warns of.
network::FlatEquations equations_with_all_signals(const network::Program& program,
                                                  const std::vector<std::size_t>& outputs) {
  std::vector<std::size_t> all = outputs;
  for (std::size_t s = 0; s < program.n_signals(); ++s) all.push_back(s);
  try {
    network::FlatEquations flat = network::flat_equations(program, all);
    if (lanes_can_run(flat.outputs)) return flat;
  } catch (
      const network::NetworkError&) {  // a signal that no state depends on: it may be none of the outputs
  }
  return network::flat_equations(program, outputs);
}

/// Gives slots in lanes to those of the equations that a tape uses.
class SlotMap {
 public:
  SlotMap(const network::FlatEquations& flat, const std::vector<std::uint32_t>& drawn_slots, LaneSpace& space)
      : flat_(flat), space_(space) {
    for (std::uint32_t k = 0; k < drawn_slots.size(); ++k) drawn_.emplace(drawn_slots[k], k);
    for (std::size_t i = 0; i < 1 + flat.n_variables; ++i) {
      const auto slot = static_cast<std::uint32_t>(
          i <= flat.n_states ? i : 1 + flat.n_states + flat.unknowns[i - 1 - flat.n_states]);
      map_.emplace(slot, static_cast<std::uint32_t>(i));
      space.slots.push_back(0);
    }
  }

  std::uint32_t operator()(std::uint32_t slot) {
    const auto [found, inserted] = map_.try_emplace(slot, static_cast<std::uint32_t>(space_.slots.size()));
    if (inserted) {
      space_.slots.push_back(flat_.initial_slots[slot]);
      if (const auto drawn = drawn_.find(slot); drawn != drawn_.end())
        space_.constants.push_back({drawn->second, found->second});
    }
    return found->second;
  }

 private:
  const network::FlatEquations& flat_;
  LaneSpace& space_;
  std::unordered_map<std::uint32_t, std::uint32_t> map_, drawn_;
};

/// A moment of a run: its time, and all variables.
struct Moment {
  double t;
  std::vector<double> variables;
};

/// What the run of the diagram as it is tells.
struct Nominal {
  std::vector<Moment> moments;
  solve::Run run;
  bool began_anew = false;
};

Nominal run_as_it_is(const network::Program& program, const diagram::FlatDiagram& diagram,
                     const network::FlatEquations& flat, solve::RunOptions options) {
  Nominal nominal;
  network::Workspace workspace(program);
  std::vector<double> rates(program.n_states());
  std::size_t row = 0;
  const std::size_t every =
      std::max<std::size_t>(static_cast<std::size_t>(options.samples) / kMostSamples, 1);
  options.on_restart = [&] {
    nominal.began_anew = true;
    nominal.moments.clear();
    row = 0;
  };
  options.on_sample = [&](double t, std::span<const double> states, std::span<const double>) {
    if (row++ % every != 0) return;
    if (!program.derivatives(t, states.data(), rates.data(), workspace)) return;
    Moment moment{t, {states.begin(), states.end()}};
    for (const std::uint32_t u : flat.unknowns) moment.variables.push_back(workspace.unknown(u));
    nominal.moments.push_back(std::move(moment));
  };
  nominal.run = solve::run(program, diagram, options);
  return nominal;
}

/// The places of ∂F/∂u and of the diagonal, and how its entries are added up.
struct Pattern {
  std::vector<StraightLu::Place> places;
  std::map<StraightLu::Place, std::uint32_t> index;

  std::uint32_t at(std::uint32_t row, std::uint32_t column) {
    const auto [found, inserted] =
        index.try_emplace({row, column}, static_cast<std::uint32_t>(places.size()));
    if (inserted) places.emplace_back(row, column);
    return found->second;
  }
};

/// ∂F/∂u of one machine at a moment, as values of the pattern's places.
std::vector<double> jacobian_at(const LaneProgram& program, const Moment& moment, std::size_t n_places) {
  const LaneKernels& kernels = *lane_kernels(4);
  const auto width = static_cast<std::size_t>(kernels.width);
  LaneArray slots(program.integration.slots.size() * width);
  for (std::size_t i = 0; i < program.integration.slots.size(); ++i) {
    const double value = i == 0                     ? moment.t
                         : i <= program.n_variables ? moment.variables[i - 1]
                                                    : program.integration.slots[i];
    std::fill_n(slots.data() + i * width, width, value);
  }
  kernels.run(program.rates.code(), slots.data());
  kernels.run(program.derivatives.code(), slots.data());
  std::vector<double> values(n_places, 0);
  for (std::size_t k = 0; k < program.matrix_steps.size(); k += 2)
    values[program.matrix_steps[k]] += slots.data()[program.matrix_steps[k + 1] * width];
  return values;
}

std::vector<double> negated(std::vector<double> values) {
  for (double& value : values) value = -value;
  return values;
}

RestGroup rest_group(const std::vector<std::size_t>& states, const std::vector<StraightLu::Place>& places) {
  RestGroup group{static_cast<std::uint32_t>(states.size())};
  const auto index_of = [&](std::uint32_t state) {
    return static_cast<std::uint32_t>(std::find(states.begin(), states.end(), state) - states.begin());
  };
  for (std::uint32_t k = 0; k < places.size(); ++k) {
    const std::uint32_t row = index_of(places[k].first), column = index_of(places[k].second);
    if (row < group.size && column < group.size) group.entries.push_back({k, row, column});
  }
  return group;
}

void renumber(LaneSpace& space, const std::vector<std::uint32_t>& slot_of) {
  std::vector<double> slots(1 + *std::max_element(slot_of.begin(), slot_of.end()), 0);
  for (std::size_t k = 0; k < space.slots.size(); ++k) slots[slot_of[k]] = space.slots[k];
  space.slots = std::move(slots);
  for (LaneConstant& constant : space.constants) constant.slot = slot_of[constant.slot];
}

void share_slots(LaneProgram& lanes) {
  std::vector<std::uint32_t> kept = lanes.rate_slots;
  for (std::size_t k = 1; k < lanes.matrix_steps.size(); k += 2) kept.push_back(lanes.matrix_steps[k]);
  for (const LaneConstant& entry : lanes.by_time) kept.push_back(entry.slot);
  LaneTape* const integration[] = {&lanes.rates, &lanes.derivatives};
  const auto slot_of = LaneTape::share_slots(integration, kept, lanes.integration.slots.size());
  renumber(lanes.integration, slot_of);
  for (std::uint32_t& slot : lanes.rate_slots) slot = slot_of[slot];
  for (std::size_t k = 1; k < lanes.matrix_steps.size(); k += 2)
    lanes.matrix_steps[k] = slot_of[lanes.matrix_steps[k]];
  for (LaneConstant& entry : lanes.by_time) entry.slot = slot_of[entry.slot];
  LaneTape* const output[] = {&lanes.outputs};
  const auto output_slot_of = LaneTape::share_slots(output, lanes.signal_slots, lanes.output.slots.size());
  renumber(lanes.output, output_slot_of);
  for (std::uint32_t& slot : lanes.output_slots) slot = output_slot_of[slot];
  for (std::uint32_t& slot : lanes.signal_slots) slot = output_slot_of[slot];
}

}  // namespace

LaneCompilation compile_for_lanes(const diagram::FlatDiagram& diagram, std::span<const std::uint32_t> varied,
                                  const solve::RunOptions& options) {
  const auto refused = [](std::string why) { return LaneCompilation{nullptr, std::move(why)}; };
  if (options.from || !options.sensitivity.empty() || options.halt_on_overload || options.extremes)
    return refused("the run asks for what lanes do not give");
  std::optional<network::Program> compiled;
  network::FlatEquations flat;
  Nominal nominal;
  std::vector<std::size_t> signals;
  try {
    compiled.emplace(network::assemble(diagram, varied));
    if (std::string why = obstacle(*compiled); !why.empty()) return refused(std::move(why));
    for (const diagram::FlatOutput& output : diagram.outputs)
      signals.push_back(compiled->signal_index(output.signal));
    flat = equations_with_all_signals(*compiled, signals);
    if (flat.n_variables > kMostVariables)
      return refused(fmt::format("the diagram has more than {} states and unknowns", kMostVariables));
    nominal = run_as_it_is(*compiled, diagram, flat, options);
  } catch (const text::Error& error) {
    const std::string& what = error.diagnostics().front().what;
    return refused("the typical machine: " + what.substr(0, what.find('\n')));
  }
  const network::Program& program = *compiled;
  for (const network::State& state : program.states()) {
    if (state.start_node) return refused(fmt::format("'{}' starts at what signals say", state.name));
  }
  if (nominal.began_anew || !nominal.run.warnings.empty() || nominal.run.event_count > 0)
    return refused("the typical machine runs with a warning, or only at a finer tolerance");
  for (const auto* tape : {&flat.rates, &flat.derivatives, &flat.outputs}) {
    if (!lanes_can_run(*tape)) return refused("the diagram has tables");
  }

  auto made = std::make_unique<LaneProgram>();
  LaneProgram& lanes = *made;
  lanes.n_states = flat.n_states;
  lanes.n_variables = flat.n_variables;
  lanes.prologue.emplace(program, varied);
  const std::vector<std::uint32_t>& drawn_slots = lanes.prologue->slots();
  SlotMap in_integration(flat, drawn_slots, lanes.integration), in_output(flat, drawn_slots, lanes.output);
  lanes.rates = LaneTape(flat.rates, std::ref(in_integration));
  lanes.derivatives = LaneTape(flat.derivatives, std::ref(in_integration));
  lanes.outputs = LaneTape(flat.outputs, std::ref(in_output));
  for (const std::uint32_t slot : flat.rate_slots) lanes.rate_slots.push_back(in_integration(slot));
  for (const std::uint32_t slot : flat.output_slots) lanes.signal_slots.push_back(in_output(slot));
  lanes.output_slots.assign(lanes.signal_slots.begin(),
                            lanes.signal_slots.begin() + static_cast<std::ptrdiff_t>(signals.size()));
  std::sort(lanes.signal_slots.begin(), lanes.signal_slots.end());
  lanes.signal_slots.erase(std::unique(lanes.signal_slots.begin(), lanes.signal_slots.end()),
                           lanes.signal_slots.end());
  lanes.bound_to_unit = options.watch_overloads;
  for (const auto& [row, slot] : flat.by_time) lanes.by_time.push_back({row, in_integration(slot)});

  Pattern pattern;
  for (std::uint32_t i = 0; i < flat.n_states; ++i) lanes.diagonal.push_back(pattern.at(i, i));
  lanes.grows.assign(flat.n_states, false);
  for (const network::MatrixEntry& entry : flat.jacobian) {
    if (entry.row < flat.n_states) lanes.grows[entry.row] = true;
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> steps;
  for (const network::MatrixEntry& entry : flat.jacobian)
    steps.emplace_back(pattern.at(entry.row, entry.column), in_integration(entry.slot));
  std::stable_sort(steps.begin(), steps.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [entry, slot] : steps) {
    lanes.matrix_steps.push_back(entry);
    lanes.matrix_steps.push_back(slot);
  }

  const auto number_at = [&](std::uint32_t slot) {
    LaneNumber number{flat.initial_slots[slot], {}};
    const auto drawn = std::find(drawn_slots.begin(), drawn_slots.end(), slot);
    if (drawn != drawn_slots.end()) number.drawn = static_cast<std::uint32_t>(drawn - drawn_slots.begin());
    return number;
  };
  for (const auto& slot : flat.start_slots) lanes.starts.push_back(slot ? number_at(*slot) : LaneNumber{});
  for (const std::uint32_t slot : *program.turning_rate_slots()) lanes.turning.push_back(number_at(slot));
  lanes.guess = nominal.moments.front().variables;
  lanes.at_rest.assign(flat.n_variables, false);
  if (options.settle) {
    for (const std::vector<std::size_t>& group : solve::servo_groups(program)) {
      for (const std::size_t i : group) lanes.at_rest[i] = true;
      lanes.rest_groups.push_back(rest_group(group, pattern.places));
    }
  }
  std::fill(lanes.at_rest.begin() + static_cast<std::ptrdiff_t>(flat.n_states), lanes.at_rest.end(), true);
  lanes.needs_rest = std::find(lanes.at_rest.begin(), lanes.at_rest.end(), true) != lanes.at_rest.end();

  for (std::uint32_t k = 0; k < pattern.places.size(); ++k) {
    const auto [row, column] = pattern.places[k];
    if (!lanes.at_rest[row]) lanes.fixed_entries.emplace_back(k, row == column ? 1 : 0);
  }

  lanes.is_explicit = nominal.run.method.method == diagram::IntegrationMethod::adams && !lanes.needs_rest;
  const double tighter = lanes.is_explicit ? kTighterVerner : kTighterRosenbrock;
  lanes.until = options.until;
  lanes.max_step = options.max_step;
  lanes.rows = options.samples;
  lanes.relative = options.tolerance / tighter;
  const double absolute =
      options.absolute_tolerance.value_or(solve::kAbsoluteTolerance * options.tolerance) / tighter;
  lanes.absolute.assign(flat.n_variables, absolute);
  for (std::size_t i = 0; i < flat.n_states; ++i) {
    if (program.states()[i].tolerance > 0) lanes.absolute[i] = program.states()[i].tolerance / tighter;
  }
  lanes.most_steps =
      std::min(static_cast<std::size_t>(options.max_steps),
               kStepsAlways + kStepsOfAFailure * static_cast<std::size_t>(nominal.run.statistics.steps));
  for (const diagram::FlatOutput& output : diagram.outputs)
    lanes.scale_and_offset.emplace_back(output.scale, output.offset);
  share_slots(lanes);
  if (lanes.is_explicit) return {std::move(made), {}};
  std::vector<std::vector<double>> samples;
  for (const Moment& moment : nominal.moments) {
    const std::vector<double> jacobian = jacobian_at(lanes, moment, pattern.places.size());
    if (!std::all_of(jacobian.begin(), jacobian.end(), [](double x) { return std::isfinite(x); })) continue;
    for (const double part : {1e-2, 1e-4, 1e-6}) {
      std::vector<double> matrix = negated(jacobian);
      for (const std::uint32_t k : lanes.diagonal)
        matrix[k] += 1 / (solve::Rodas5p::kGamma * part * options.until);
      samples.push_back(std::move(matrix));
    }
    if (!lanes.needs_rest) continue;
    std::vector<double> matrix = negated(jacobian);
    for (const auto& [entry, value] : lanes.fixed_entries) matrix[entry] = value;
    samples.push_back(std::move(matrix));
  }
  if (samples.empty()) return refused("the equations have no linearisation along the run");
  auto lu = StraightLu::make(static_cast<std::uint32_t>(flat.n_variables), pattern.places, samples);
  if (!lu) return refused("no one order of elimination suits the whole run");
  lanes.lu = std::move(*lu);
  return {std::move(made), {}};
}

}  // namespace oblique::ensemble
