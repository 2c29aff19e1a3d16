// SPDX-License-Identifier: MIT
#include <oblique/solve/sensitivity/sensitivities.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Dense>

#include <oblique/network/assembly/network.h>
#include <oblique/network/assembly/parameter_numbers.h>
#include <oblique/network/program/parameter_setting.h>
#include <oblique/solve/events/time_resolution.h>
#include <oblique/solve/solve_error.h>

namespace oblique::solve {
namespace {

/// How far beside its value the k-th parameter is put for the equations to be compiled: there nothing is left
/// out because a factor is 0 or 1. Each lies beside by a part of its own, the fractions of multiples of the
/// golden ratio: (1 + a)/(1 + b), of two that are 0, is 1 where both lie beside alike.
double beside(double value, std::size_t k) {
  constexpr double kPart = 7.2360679e-4;
  const double multiple = static_cast<double>(k) * std::numbers::phi;
  const double part = kPart * (1 + multiple - std::floor(multiple));
  return value == 0 ? part : value * (1 + part);
}

}  // namespace

Sensitivities::Sensitivities(const network::Program& program, const diagram::FlatDiagram& diagram,
                             std::vector<SensitivityParameter> parameters, double span)
    : diagram_(diagram),
      parameters_(std::move(parameters)),
      span_(span),
      run_states_(program.states()),
      run_switches_(program.switches()),
      run_events_(program.events()),
      mode_states_(program.mode_states()),
      n_unknowns_(program.unknowns().size()),
      n_discrete_states_(program.discrete_states().size()),
      memories_(parameters_.size(), std::vector<double>(n_discrete_states_)),
      states_(parameters_.size(), std::vector<double>(run_states_.size())),
      memories_move_(parameters_.size()),
      phase_delays_(parameters_.size()) {
  const network::ParameterNumbers numbers(diagram);
  diagram::FlatDiagram other = diagram;
  std::vector<std::uint32_t> wanted;
  std::vector<network::ParameterSetting::Parameter> values;
  for (const SensitivityParameter& parameter : parameters_) {
    wanted.push_back(parameter.number);
    values.push_back({parameter.number, parameter.value});
  }
  for (std::size_t b = 0; b < other.blocks.size(); ++b) {
    diagram::FlatBlock& block = other.blocks[b];
    bool changed = false;
    const auto put_beside = [&](std::uint32_t number, double& value) {
      const auto found = std::find(wanted.begin(), wanted.end(), number);
      if (found == wanted.end()) return;
      value = beside(value, static_cast<std::size_t>(found - wanted.begin()));
      changed = true;
    };
    for (std::size_t k = 0; k < block.parameters.size(); ++k)
      put_beside(numbers.parameter(b, k), block.parameters[k]);
    for (std::size_t input = 0; input < block.inputs.size(); ++input) {
      for (std::size_t wire = 0; wire < block.inputs[input].terms.size(); ++wire)
        put_beside(numbers.weight(b, input, wire), block.inputs[input].terms[wire].weight);
    }
    if (changed) block.choose_behaviour();
  }
  network::Network made = network::assemble(other);
  const auto same = [](const auto& ours, const auto& theirs) {
    return std::equal(ours.begin(), ours.end(), theirs.begin(), theirs.end(),
                      [](const auto& a, const auto& b) { return a.name == b.name; });
  };
  if (!same(made.states, program.states()) || !same(made.unknowns, program.unknowns()) ||
      !same(made.discrete_states, program.discrete_states()) || made.events.size() != run_events_.size())
    refuse(0, "next to its value a parameter makes another circuit, of other elements");
  network::ParameterDerivatives columns = network::with_parameter_derivatives(made, wanted);
  first_angle_ = made.signals.size();
  for (network::NodeId id = 0; id < made.graph.size(); ++id) {
    const network::Node& node = made.graph[id];
    if (node.op != network::Op::atan2 || !node.continuous) continue;
    made.signals.insert(made.signals.end(), {node.a, node.b});
    made.signal_names.insert(made.signal_names.end(), 2, "of an angle");
    ++n_angles_;
  }
  layout_ = network::with_tangents(std::move(made), wanted);
  network::Network rates = layout_.network;
  for (std::size_t i = 0; i < rates.states.size(); ++i)
    rates.states[i].derivative = rates.signals[layout_.derivatives + i];
  rates.signals.clear();
  rates.signal_names.clear();
  const auto compiled = [&](network::Network network) {
    const network::Program beside_them(std::move(network));
    network::ParameterSetting setting(beside_them);
    if (!setting.set_beside(values))
      refuse(0,
             "a parameter decides what the equations are (a table, a check interval, a value at the start)");
    return std::make_unique<network::Program>(beside_them, setting);
  };
  program_ = compiled(std::move(layout_.network));
  rates_program_ = compiled(std::move(rates));
  columns_program_ = compiled(std::move(columns.network));
  entries_ = std::move(columns.entries);
  entry_values_.resize(entries_.size());
  workspace_ = std::make_unique<network::Workspace>(*program_);
  columns_workspace_ = std::make_unique<network::Workspace>(*columns_program_);
  rates_workspace_ = std::make_unique<network::Workspace>(*rates_program_);
  jacobian_.resize(program_->jacobian_pattern().entries());
  by_parameter_.assign(parameters_.size(), std::vector<double>(run_states_.size()));
  held_.resize(program_->discrete_states().size());
  values_.resize(program_->n_signals());
}

std::vector<double> Sensitivities::scales() const {
  std::vector<double> scales;
  for (const SensitivityParameter& parameter : parameters_)
    scales.push_back(std::max(1.0, std::abs(parameter.value)));
  return scales;
}

void Sensitivities::refuse(double t, const std::string& why) const {
  throw SolveError(SolveError::Kind::other, t,
                   {{diagram_.file, {}},
                    fmt::format("the sensitivities are not known at t = {:.6g} s: {}", t, why),
                    {},
                    "run without sensitivities, or until before then"});
}

void Sensitivities::refuse_slide(double t) const {
  refuse(t, "the solution slides along a switching surface from there");
}

void Sensitivities::refuse_jump(double t) const {
  refuse(t, "an algebraic loop leaves its branch and jumps to another solution");
}

void Sensitivities::refuse_growth(double t, const std::vector<std::vector<double>>& s) const {
  constexpr double kHuge = 1e150;  // its square, which is in their error, is no number any more
  for (const std::vector<double>& by_one : s) {
    for (std::size_t i = 0; i < by_one.size(); ++i) {
      if (std::abs(by_one[i]) <= kHuge) continue;
      refuse(t, fmt::format("that of '{}' has grown to {:.2g}, as where small disturbances grow without end",
                            run_states_[i].name, by_one[i]));
    }
  }
}

void Sensitivities::load(const network::Workspace& run) {
  discrete_states_.assign(run.discrete_states().begin(), run.discrete_states().end());
  for (std::size_t u = 0; u < n_unknowns_; ++u) {
    workspace_->set_unknown(u, run.unknown(u));
    rates_workspace_->set_unknown(u, run.unknown(u));
    columns_workspace_->set_unknown(u, run.unknown(u));
  }
  columns_workspace_->load_discrete_states(discrete_states_);
  for (std::size_t k = 0; k < count(); ++k) {
    memories_move_[k] =
        std::any_of(memories_[k].begin(), memories_[k].end(), [](double moves) { return moves != 0; });
  }
  known_time_.reset();
}

void Sensitivities::hold(const Direction& along) {
  std::copy(discrete_states_.begin(), discrete_states_.end(), held_.begin());
  std::fill(held_.begin() + static_cast<std::ptrdiff_t>(n_discrete_states_), held_.end(), 0.0);
  held_[layout_.time] = along.time;
  std::copy(along.states.begin(), along.states.end(),
            held_.begin() + static_cast<std::ptrdiff_t>(layout_.first_state));
  if (along.parameter) {
    const std::vector<double>& memories = memories_[*along.parameter];
    std::copy(memories.begin(), memories.end(),
              held_.begin() + static_cast<std::ptrdiff_t>(layout_.first_discrete_state));
    held_[layout_.first_parameter + *along.parameter] = 1;
  }
}

bool Sensitivities::evaluate(double t, const double* x, const Direction& along) {
  hold(along);
  workspace_->load_discrete_states(held_);
  return program_->signals(t, x, values_.data(), *workspace_).has_value();
}

void Sensitivities::evaluate_or_refuse(double t, std::span<const double> x, const Direction& along) {
  if (!evaluate(t, x.data(), along)) refuse(t, "an algebraic loop has no derivative there");
}

/// ∂f/∂x and ∂f/∂p, of which a solver asks at one place for all parameters, several times.
bool Sensitivities::differentiate_rates(double t, const double* x) {
  const std::size_t n = run_states_.size();
  if (known_time_ == t && std::equal(known_states_.begin(), known_states_.end(), x)) return true;
  known_time_.reset();
  hold({});
  workspace_->load_discrete_states(held_);
  if (!program_->jacobian(t, x, jacobian_.data(), *workspace_)) return false;
  if (!columns_program_->signals(t, x, entry_values_.data(), *columns_workspace_)) return false;
  for (std::size_t k = 0; k < count(); ++k) {
    std::fill(by_parameter_[k].begin(), by_parameter_[k].end(), 0.0);
    if (!memories_move_[k]) continue;
    hold({0, {}, k});
    rates_workspace_->load_discrete_states(held_);
    if (!rates_program_->derivatives(t, x, by_parameter_[k].data(), *rates_workspace_)) return false;
  }
  for (std::size_t e = 0; e < entries_.size(); ++e) {
    const auto& [state, k] = entries_[e];
    if (!memories_move_[k]) by_parameter_[k][state] = entry_values_[e];
  }
  known_states_.assign(x, x + n);
  known_time_ = t;
  return true;
}

bool Sensitivities::rates(double t, const double* x, std::size_t k, const double* s, double* rates) {
  if (!differentiate_rates(t, x)) return false;
  std::copy(by_parameter_[k].begin(), by_parameter_[k].end(), rates);
  const network::SparsePattern& pattern = program_->jacobian_pattern();
  for (std::size_t column = 0; column < run_states_.size(); ++column) {
    for (auto entry = pattern.column_starts[column]; entry < pattern.column_starts[column + 1]; ++entry)
      rates[pattern.rows[static_cast<std::size_t>(entry)]] +=
          jacobian_[static_cast<std::size_t>(entry)] * s[column];
  }
  return true;
}

void Sensitivities::outputs(double t, std::span<const double> x, const std::vector<std::vector<double>>& s,
                            std::span<double> values) {
  for (std::size_t k = 0; k < count(); ++k) {
    evaluate_or_refuse(t, x, {0, s[k], k});
    for (std::size_t o = 0; o < diagram_.outputs.size(); ++o) {
      const diagram::FlatOutput& output = diagram_.outputs[o];
      values[o * count() + k] =
          output.scale * values_[layout_.signals + program_->signal_index(output.signal)];
    }
  }
}

void Sensitivities::output_by_states(double t, std::span<const double> x, std::size_t output,
                                     std::span<double> values) {
  const diagram::FlatOutput& wanted = diagram_.outputs[output];
  std::vector<double> unit(run_states_.size());
  for (std::size_t i = 0; i < unit.size(); ++i) {
    unit[i] = 1;
    evaluate_or_refuse(t, x, {0, unit, {}});
    unit[i] = 0;
    values[i] = wanted.scale * values_[layout_.signals + program_->signal_index(wanted.signal)];
  }
}

void Sensitivities::pass(double from, double to, const Interpolant& within) {
  if (n_angles_ == 0) return;
  std::vector<double> x(run_states_.size());
  const auto coordinates_at = [&](double t) {
    within.states_at(t, x);
    evaluate_or_refuse(t, x, {});
    const auto begin = values_.begin() + static_cast<std::ptrdiff_t>(first_angle_);
    return std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(2 * n_angles_));
  };
  const std::vector<double> before = coordinates_at(from), after = coordinates_at(to);
  for (std::size_t angle = 0; angle < n_angles_; ++angle) {
    if ((before[2 * angle] < 0) != (after[2 * angle] < 0)) refuse_jump_of_angle(angle, from, to, within);
  }
}

/// Where y of an atan2(y, x) changes its sign with x below zero, it goes over from π to −π or back. What
/// follows from it alone, or from its sine, does not care: what integrates it, or compares it, does.
void Sensitivities::refuse_jump_of_angle(std::size_t angle, double from, double to,
                                         const Interpolant& within) {
  constexpr double kMoment = 1e-9;  // of the way from one end to the other
  constexpr double kJump = 1e-6;    // in so short a time: of what is compared, or of a machine unit
  std::vector<double> x(run_states_.size()), rates(x.size());
  const auto look = [&](double t) {
    within.states_at(t, x);
    evaluate_or_refuse(t, x, {});
    return values_[first_angle_ + 2 * angle] < 0;
  };
  const auto followers = [&](double t) {
    look(t);
    if (!program_->derivatives(t, x.data(), rates.data(), *workspace_)) refuse(t, "an algebraic loop fails");
    std::vector<double> all = rates;
    const auto events = values_.begin() + static_cast<std::ptrdiff_t>(layout_.event_values);
    all.insert(all.end(), events, events + static_cast<std::ptrdiff_t>(run_switches_.size()));
    return all;
  };
  double low = from, high = to;
  const bool below = look(from);
  while (high - low > std::max(kMoment * (to - from), time_resolution(to))) {
    const double middle = (low + high) / 2;
    (look(middle) == below ? low : high) = middle;
  }
  if (values_[first_angle_ + 2 * angle + 1] >= 0) return;
  const std::vector<double> before = followers(low), after = followers(high);
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (!(std::abs(after[i] - before[i]) <= kJump * (1 + std::abs(before[i]))))
      refuse(high, "an angle goes past 180° there, where atan2 jumps by a turn");
  }
}

/// States may start from what events have set at the start, and that from where states start.
void Sensitivities::start(double t, std::span<const double> x, const network::Workspace& run,
                          const std::vector<std::size_t>& served, bool from_state) {
  constexpr int kMostRounds = 3;
  load(run);
  if (from_state) return;
  for (int round = 0;; ++round) {
    start_memories(t, x, run, served);
    if (round == 0) refuse_turns_at_start(t, x);
    const std::vector<std::vector<double>> before = states_;
    start_states(t, x);
    if (states_ == before) return;
    if (round == kMostRounds) refuse(t, "what is stored and the states start from each other");
  }
}

/// Where f of a state is held at zero, ∂f/∂x s + ∂f/∂p is; where it is given by a value, s is the derivative
/// of that: one linear system for all.
void Sensitivities::start_states(double t, std::span<const double> x) {
  const auto n = static_cast<Eigen::Index>(run_states_.size());
  const std::vector<double> starts = program_->start();
  evaluate_or_refuse(t, x, {});
  const bool any_at_rest =
      std::any_of(run_states_.begin(), run_states_.end(), [](const auto& state) { return state.at_rest; });
  const std::vector<double> rates = [&] {
    std::vector<double> all(run_states_.size());
    if (!program_->derivatives(t, x.data(), all.data(), *workspace_)) refuse(t, "an algebraic loop fails");
    return all;
  }();
  std::vector<double> unit(run_states_.size());
  // How fast each state would move at the most, were another one off by a machine unit.
  std::vector<double> steepest(run_states_.size());
  for (std::size_t j = 0; any_at_rest && j < unit.size(); ++j) {
    unit[j] = 1;
    evaluate_or_refuse(t, x, {0, unit, {}});
    unit[j] = 0;
    for (std::size_t i = 0; i < steepest.size(); ++i)
      steepest[i] = std::max(steepest[i], std::abs(values_[layout_.derivatives + i]));
  }
  std::vector<bool> rests(run_states_.size());
  bool any_rests = false, all_given = true;
  for (std::size_t i = 0; i < rests.size(); ++i) {
    constexpr double kAtRest = 1e-6;     // of what its own start would make of it
    constexpr double kRounding = 1e-12;  // of a machine unit: a fast amplifier makes a rate of it
    rests[i] = run_states_[i].at_rest &&
               std::abs(rates[i]) <= std::max(kAtRest, kRounding * steepest[i]) * (1 + std::abs(x[i]));
    any_rests = any_rests || rests[i];
    all_given = all_given && (rests[i] || run_states_[i].start_node || x[i] == starts[i]);
  }
  const auto column = [&](const Direction& along) {
    evaluate_or_refuse(t, x, along);
    Eigen::VectorXd values(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto at = static_cast<std::size_t>(i);
      values(i) = rests[at] ? values_[layout_.derivatives + at] : -values_[layout_.starts + at];
    }
    return values;
  };
  if (!all_given) refuse(t, "an event has set a state where the run starts");
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  const bool dense = any_rests || std::any_of(run_states_.begin(), run_states_.end(),
                                              [](const auto& state) { return state.start_node.has_value(); });
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto at = static_cast<std::size_t>(j);
    if (dense) {
      unit[at] = 1;
      matrix.col(j) = column({0, unit, {}});
      unit[at] = 0;
    }
    if (!rests[at]) matrix(j, j) += 1;
  }
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(matrix);
  for (std::size_t k = 0; k < count(); ++k) {
    const Eigen::VectorXd s = -lu.solve(column({0, {}, k}));
    if (!s.allFinite()) refuse(t, "the rest from which the run starts is singular");
    for (Eigen::Index i = 0; i < n; ++i) states_[k][static_cast<std::size_t>(i)] = s(i);
  }
}

/// What events have set where the run starts, from what the memories were before them.
void Sensitivities::start_memories(double t, std::span<const double> x, const network::Workspace& run,
                                   const std::vector<std::size_t>& served) {
  const std::vector<double> now = discrete_states_;
  const network::Workspace fresh(*program_);
  const std::vector<bool> positions = are_positions();
  for (std::size_t m = 0; m < n_discrete_states_; ++m) {
    if (!positions[m]) discrete_states_[m] = fresh.discrete_state(static_cast<std::uint32_t>(m));
  }
  before_.x.assign(x.begin(), x.end());
  memories_.assign(count(), std::vector<double>(n_discrete_states_));
  std::vector<std::vector<double>> memories = memories_;
  for (std::size_t m = 0; m < n_discrete_states_; ++m) {
    if (now[m] == discrete_states_[m] && !is_set(served, false, m)) continue;
    const auto action = matching_action(t, served, false, m, now[m]);
    if (!action && !any_action_moves(served)) continue;
    if (!action)
      refuse(t, "several events one after the other have set a discrete state where the run starts");
    for (std::size_t k = 0; k < count(); ++k) {
      evaluate_or_refuse(t, x, {0, states_[k], k});
      memories[k][m] = values_[*action + 1];
    }
  }
  memories_ = std::move(memories);
  load(run);
}

/// Whether what any of these events sets may move with a parameter.
bool Sensitivities::any_action_moves(const std::vector<std::size_t>& served) const {
  return std::any_of(served.begin(), served.end(), [&](std::size_t e) {
    const std::vector<bool>& moves = layout_.actions_move[e];
    return std::find(moves.begin(), moves.end(), true) != moves.end();
  });
}

/// What turns over just where the run starts would do so later with a parameter on one side of its value, and
/// with one on the other have done so before.
void Sensitivities::refuse_turns_at_start(double t, std::span<const double> x) {
  evaluate_or_refuse(t, x, {});
  std::vector<std::size_t> at_zero;
  for (std::size_t w = 0; w < run_switches_.size(); ++w) {
    if (values_[layout_.event_values + w] == 0) at_zero.push_back(w);
  }
  const std::vector<std::vector<double>> still(count());
  refuse_moved(at_zero, t, x, still, "where the run starts");
}

/// What an event has put on its switching point, where it stays.
void Sensitivities::refuse_rests(double t, std::span<const double> x, const std::vector<double>& rates) {
  evaluate_or_refuse(t, x, {1, rates, {}});
  std::vector<std::size_t> at_zero;
  for (std::size_t w = 0; w < run_switches_.size(); ++w) {
    if (values_[layout_.event_values + w] == 0 && values_[layout_.event_functions + w] == 0)
      at_zero.push_back(w);
  }
  refuse_moved(at_zero, t, x, states_, "from there");
}

/// These switches lie at their switching points, and do not with another parameter: with what moves by
/// `states` along with each.
void Sensitivities::refuse_moved(const std::vector<std::size_t>& at_zero, double t, std::span<const double> x,
                                 const std::vector<std::vector<double>>& states, std::string_view where) {
  constexpr double kMoves = 1e-9;  // [machine unit], of which rounding makes no more
  for (std::size_t k = 0; !at_zero.empty() && k < count(); ++k) {
    evaluate_or_refuse(t, x, {0, states[k], k});
    for (const std::size_t w : at_zero) {
      if (!(std::abs(values_[layout_.event_functions + w]) * scales()[k] > kMoves)) continue;
      refuse(t, fmt::format("'{}' of block '{}' lies at its switching point {}, and with another "
                            "parameter it would not",
                            run_switches_[w].comparison, run_switches_[w].block, where));
    }
  }
}

std::vector<bool> Sensitivities::are_positions() const {
  std::vector<bool> found(n_discrete_states_, false);
  for (const network::Switch& s : run_switches_) found[s.discrete_state] = true;
  for (const std::uint32_t mode : mode_states_) found[mode] = true;
  return found;
}

void Sensitivities::before_event(double t, std::span<const double> x, std::vector<std::vector<double>> s) {
  before_.x.assign(x.begin(), x.end());
  before_.s = std::move(s);
  before_.rates.resize(x.size());
  evaluate_or_refuse(t, x, {});
  if (!program_->derivatives(t, x.data(), before_.rates.data(), *workspace_))
    refuse(t, "an algebraic loop fails");
  evaluate_or_refuse(t, x, {1, before_.rates, {}});
  const auto values = [&](std::size_t first) {
    const auto begin = values_.begin() + static_cast<std::ptrdiff_t>(first);
    return std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(run_switches_.size()));
  };
  before_.event_values = values(layout_.event_values);
  before_.event_rates = values(layout_.event_functions);
}

/// dt*/dp of each parameter: of the switch whose event function is zero, whether it has stayed turned over or
/// a reset has brought it back. `acts`: something depends on when that was.
std::vector<double> Sensitivities::delays(double t, const std::vector<double>& discrete_states, bool acts) {
  constexpr double kSameTime = 1e-8;   // of the run: how exactly an event is located, at the worst
  constexpr double kSameDelay = 1e-6;  // relative
  std::vector<double> delays(count());
  const auto turned = [&](std::size_t w) {
    const std::uint32_t m = run_switches_[w].discrete_state;
    return discrete_states[m] != discrete_states_[m];
  };
  bool found = false, any_turned = false;
  for (const bool of_turned : {true, false}) {
    if (found) break;
    for (std::size_t w = 0; w < run_switches_.size(); ++w) {
      any_turned = any_turned || turned(w);
      if (turned(w) != of_turned) continue;
      const double rate = before_.event_rates[w];
      if (!(std::abs(before_.event_values[w]) <= std::abs(rate) * kSameTime * span_) || rate == 0) continue;
      std::vector<double> other;
      for (std::size_t k = 0; k < count(); ++k) {
        evaluate_or_refuse(t, before_.x, {0, before_.s[k], k});
        other.push_back(-values_[layout_.event_functions + w] / rate);
      }
      for (std::size_t k = 0; found && acts && k < count(); ++k) {
        if (std::abs(other[k] - delays[k]) > kSameDelay * (std::abs(delays[k]) + span_ / scales()[k] * 1e-9))
          refuse(t, fmt::format("'{}' of block '{}' turns over at the same time as another switch, and with "
                                "another parameter it would not",
                                run_switches_[w].comparison, run_switches_[w].block));
      }
      if (!found) delays = other;
      found = true;
    }
  }
  const bool by_time = std::any_of(mode_states_.begin(), mode_states_.end(), [&](std::uint32_t mode) {
    return discrete_states[mode] != discrete_states_[mode];
  });
  if (!found && !by_time && acts && any_turned)
    refuse(t, "a switch turns over where its event function only touches zero");
  // A phase of a given length ends later by as much as it began later.
  if (by_time && found) phase_delays_ = delays;
  return by_time && !found ? phase_delays_ : delays;
}

/// Whether an event that came has set this, be it to the value that it had: that may move with a parameter
/// otherwise than it did.
bool Sensitivities::is_set(const std::vector<std::size_t>& served, bool on_state, std::size_t index) const {
  return std::any_of(served.begin(), served.end(), [&](std::size_t e) {
    const auto& actions = run_events_[e].actions;
    return std::any_of(actions.begin(), actions.end(), [&](const network::Event::Action& action) {
      return action.on_state == on_state && action.index == index;
    });
  });
}

/// The last action of the events that came which would set this to that value, as the place of its signals.
std::optional<std::size_t> Sensitivities::matching_action(double t, const std::vector<std::size_t>& served,
                                                          bool on_state, std::size_t index, double value) {
  evaluate_or_refuse(t, before_.x, {});
  constexpr double kSame = 1e-9;
  const std::vector<std::size_t> last_first(served.rbegin(), served.rend());
  for (const std::size_t e : last_first) {
    for (std::size_t a = 0; a < run_events_[e].actions.size(); ++a) {
      const network::Event::Action& action = run_events_[e].actions[a];
      if (action.on_state != on_state || action.index != index) continue;
      const std::size_t place = layout_.actions[e][a];
      if (std::abs(values_[place] - value) <= kSame * (1 + std::abs(value))) return place;
    }
  }
  return std::nullopt;
}

void Sensitivities::after_event(double t, std::span<const double> x, const network::Workspace& run,
                                const std::vector<std::size_t>& served) {
  const std::vector<double> discrete_states(run.discrete_states().begin(), run.discrete_states().end());
  const std::size_t n = run_states_.size();
  struct Set {
    std::size_t index, action;
  };
  std::vector<Set> set_states, set_memories;
  for (std::size_t i = 0; i < n; ++i) {
    if (x[i] == before_.x[i] && !is_set(served, true, i)) continue;
    const auto action = matching_action(t, served, true, i, x[i]);
    if (!action)
      refuse(t, fmt::format("several events one after the other have set '{}'", run_states_[i].name));
    set_states.push_back({i, *action});
  }
  const std::vector<bool> is_position = are_positions();
  for (std::size_t m = 0; m < n_discrete_states_; ++m) {
    if (is_position[m] || (discrete_states[m] == discrete_states_[m] && !is_set(served, false, m))) continue;
    const auto action = matching_action(t, served, false, m, discrete_states[m]);
    if (!action) refuse(t, "several events one after the other have set a discrete state");
    set_memories.push_back({m, *action});
  }
  // dx/dt on the other side, with the positions as they are now.
  const std::vector<double> positions_before = discrete_states_;
  load(run);
  std::vector<double> rates(n);
  evaluate_or_refuse(t, x, {});
  if (!program_->derivatives(t, x.data(), rates.data(), *workspace_)) refuse(t, "an algebraic loop fails");
  discrete_states_ = positions_before;

  const bool acts = rates != before_.rates || !set_states.empty() || !set_memories.empty();
  const std::vector<double> delay = delays(t, discrete_states, acts);
  states_ = before_.s;
  std::vector<std::vector<double>> memories = memories_;
  for (std::size_t k = 0; k < count(); ++k) {
    std::vector<double> moved(n);
    for (std::size_t i = 0; i < n; ++i) {
      moved[i] = before_.s[k][i] + before_.rates[i] * delay[k];
      states_[k][i] = moved[i] - rates[i] * delay[k];
    }
    if (set_states.empty() && set_memories.empty()) continue;
    evaluate_or_refuse(t, before_.x, {delay[k], moved, k});
    for (const auto& [i, action] : set_states) states_[k][i] = values_[action + 1] - rates[i] * delay[k];
    for (const auto& [m, action] : set_memories) memories[k][m] = values_[action + 1];
  }
  memories_ = std::move(memories);
  load(run);
  refuse_rests(t, x, rates);
}

}  // namespace oblique::solve
