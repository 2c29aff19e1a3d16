// SPDX-License-Identifier: MIT
#include <oblique/network/program/program.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <oblique/network/program/parameter_setting.h>
#include <oblique/network/program/program_compiler.h>

namespace oblique::network {

Program::Program(Network network)
    : code_(std::make_shared<const ProgramCode>(compile(std::move(network)))),
      initial_slots_(code_->initial_slots) {}

Program::Program(const Program& other, const ParameterSetting& parameters)
    : code_(other.code_), initial_slots_(other.initial_slots_) {
  parameters.write(initial_slots_);
}

std::vector<double> Program::start() const {
  std::vector<double> x;
  x.reserve(code_->states.size());
  for (const auto& slot : code_->fixed_start_slots) x.push_back(slot ? initial_slots_[*slot] : 0);
  return x;
}

bool Program::run(const std::vector<ProgramCode::Step>& steps, Workspace& workspace) const {
  double* const slots = workspace.slots_.data();
  const std::span<const Instruction> tape(code_->tape);
  const std::size_t first_unknown = 1 + code_->states.size();
  for (const ProgramCode::Step& step : steps) {
    run_tape(tape.subspan(step.segment.begin, step.segment.end - step.segment.begin), slots);
    if (!step.loop) continue;
    const LoopCode& loop = code_->loop_codes[*step.loop];
    const LoopFailure failure = workspace.loops_[*step.loop].solve_loop(loop, tape, slots);
    if (failure != LoopFailure::none) {
      const double derivative = loop.size() == 1 && !loop.jacobian.empty() ? slots[loop.jacobian[0].slot] : 0;
      workspace.trouble_ = {*step.loop, failure, derivative,
                            workspace.solved_[loop.unknown_slots.front() - first_unknown]};
      for (const std::uint32_t slot : loop.unknown_slots)
        slots[slot] = workspace.solved_[slot - first_unknown];
      if (!workspace.passes_failing_loops_) return false;
      continue;
    }
    for (const std::uint32_t slot : loop.unknown_slots) workspace.solved_[slot - first_unknown] = slots[slot];
  }
  return true;
}

bool Program::load_and_run(double t, const double* x, Workspace& workspace) const {
  ++workspace.generation_;
  workspace.slots_[0] = t;
  std::copy(x, x + code_->states.size(), workspace.slots_.begin() + 1);
  return run(code_->derivative_steps, workspace);
}

bool Program::derivatives(double t, const double* x, double* dxdt, Workspace& workspace) const {
  if (!load_and_run(t, x, workspace)) return false;
  copy_derivatives(workspace, dxdt);
  return true;
}

void Program::copy_derivatives(const Workspace& workspace, double* dxdt) const {
  for (std::size_t i = 0; i < code_->derivative_slots.size(); ++i)
    dxdt[i] = workspace.slots_[code_->derivative_slots[i]];
}

std::optional<SignalEvaluation> Program::signals(double t, const double* x, double* values,
                                                 Workspace& workspace) const {
  if (!load_and_run(t, x, workspace) || !run(code_->event_function_steps, workspace) ||
      !run(code_->signal_steps, workspace))
    return std::nullopt;
  for (std::size_t i = 0; i < code_->signal_slots.size(); ++i)
    values[i] = workspace.slots_[code_->signal_slots[i]];
  return SignalEvaluation(*this, workspace);
}

std::optional<Evaluation> Program::event_functions(double t, const double* x, double* values,
                                                   Workspace& workspace) const {
  if (!load_and_run(t, x, workspace) || !run(code_->event_function_steps, workspace)) return std::nullopt;
  for (std::size_t i = 0; i < code_->event_function_slots.size(); ++i)
    values[i] = workspace.slots_[code_->event_function_slots[i]];
  return Evaluation(*this, workspace);
}

void Program::decide_in_order(double t, const double* x, const double* dxdt, Workspace& workspace,
                              const Decide& decide) const {
  ++workspace.generation_;
  double* const slots = workspace.slots_.data();
  slots[0] = t;
  std::copy(x, x + code_->states.size(), slots + 1);
  std::copy(dxdt, dxdt + code_->states.size(), slots + code_->first_rate);
  for (const auto& [segment, s] : code_->switch_order) {
    run_tape(std::span(code_->tape).subspan(segment.begin, segment.end - segment.begin), slots);
    decide(s, slots[code_->event_function_slots[s]], slots[code_->event_function_rate_slots[s]]);
  }
}

std::vector<Interval> Program::source_slots() const {
  std::vector<Interval> slots;
  if (code_->sources.empty()) return slots;
  slots.reserve(initial_slots_.size());
  for (const double value : initial_slots_) slots.push_back({value, value});
  return slots;
}

void Program::source_ranges(const Interval& time, std::span<const Interval> states,
                            const Workspace& workspace, std::span<Interval> slots) const {
  slots[0] = time;
  for (std::size_t k = 0; k < states.size(); ++k) slots[1 + code_->source_states[k]] = states[k];
  for (std::size_t m = code_->first_discrete_state;
       m < code_->first_discrete_state + code_->discrete_states.size(); ++m)
    slots[m] = {workspace.slots_[m], workspace.slots_[m]};
  run_tape(std::span(code_->tape)
               .subspan(code_->source_segment.begin, code_->source_segment.end - code_->source_segment.begin),
           slots);
}

bool Program::derivatives_need(std::size_t loop) const {
  return std::any_of(code_->derivative_steps.begin(), code_->derivative_steps.end(),
                     [&](const ProgramCode::Step& step) { return step.loop == loop; });
}

bool Program::loop_repeats(std::size_t loop) const {
  using Code = Instruction::Code;
  const LoopCode& code = code_->loop_codes[loop];
  std::vector<bool> by_unknowns(initial_slots_.size());
  for (const std::uint32_t slot : code.unknown_slots) by_unknowns[slot] = true;
  for (std::uint32_t k = code.body.begin; k < code.body.end; ++k) {
    const Instruction& i = code_->tape[k];
    const int operands = operand_count(i.code);
    by_unknowns[i.result] =
        by_unknowns[i.a] || (operands > 1 && by_unknowns[i.b]) || (operands > 2 && by_unknowns[i.c]);
    if ((i.code == Code::sin || i.code == Code::cos || i.code == Code::tan) && by_unknowns[i.a]) return true;
  }
  return false;
}

bool Program::differentiate_loops(Workspace& workspace) const {
  const double* const slots = workspace.slots_.data();
  for (const std::uint32_t l : code_->sensitivity_order) {
    const ProgramCode::Sensitivity& sensitivity = code_->sensitivities[l];
    Eigen::MatrixXd& dz_dx = workspace.dz_dx_[l];
    dz_dx.setZero();
    for (const MatrixEntry& entry : sensitivity.direct) dz_dx(entry.row, entry.column) -= slots[entry.slot];
    for (const ProgramCode::Coupling& coupling : sensitivity.couplings) {
      const Eigen::MatrixXd& other = workspace.dz_dx_[coupling.loop];
      for (const MatrixEntry& entry : coupling.entries) {
        for (std::size_t k = 0; k < coupling.targets.size(); ++k) {
          dz_dx(entry.row, coupling.targets[k]) -=
              slots[entry.slot] * other(entry.column, static_cast<Eigen::Index>(k));
        }
      }
    }
    const LoopCode& loop = code_->loop_codes[l];
    if (!workspace.loops_[l].matrix().factor(loop, slots)) {
      // Solved where its branch ends, or passed over: nothing moves it there.
      if (workspace.passes_failing_loops_ || (loop.size() == 1 && loop.has_branches())) {
        dz_dx.setZero();
        continue;
      }
      const std::uint32_t first = loop.unknown_slots.front();
      workspace.trouble_ = {l, LoopFailure::singular, 0, slots[first]};
      return false;
    }
    workspace.loops_[l].matrix().solve(dz_dx);
  }
  return true;
}

/// Takes from differences the columns in which an entry has no value, though the derivatives have: 1/(1 +
/// e^x) is next to nothing where e^x has no number any more.
void Program::complete_jacobian(double t, const double* x, double* values, Workspace& workspace) const {
  constexpr double kStep = 1e-7;  // about the root of rounding, of a machine unit or of the state
  const auto all_known = [values](auto begin, auto end) {
    return std::all_of(values + begin, values + end, [](double value) { return std::isfinite(value); });
  };
  if (all_known(std::size_t{0}, code_->pattern.entries())) return;
  const std::size_t n = code_->states.size();
  std::vector<double> moved(x, x + n), here(n), there(n);
  copy_derivatives(workspace, here.data());
  for (std::size_t column = 0; column < n; ++column) {
    const auto begin = code_->pattern.column_starts[column], end = code_->pattern.column_starts[column + 1];
    if (all_known(begin, end)) continue;
    moved[column] += kStep * std::max(1.0, std::abs(x[column]));
    const bool known = derivatives(t, moved.data(), there.data(), workspace);
    for (auto k = begin; known && k < end; ++k) {
      const auto row = static_cast<std::size_t>(code_->pattern.rows[static_cast<std::size_t>(k)]);
      if (!std::isfinite(values[k])) values[k] = (there[row] - here[row]) / (moved[column] - x[column]);
    }
    moved[column] = x[column];
  }
  load_and_run(t, x, workspace);
}

bool Program::jacobian(double t, const double* x, double* values, Workspace& workspace) const {
  if (!load_and_run(t, x, workspace)) return false;
  double* const slots = workspace.slots_.data();
  run_tape(std::span(code_->tape)
               .subspan(code_->jacobian_segment.begin,
                        code_->jacobian_segment.end - code_->jacobian_segment.begin),
           slots);
  if (!differentiate_loops(workspace)) return false;
  std::fill(values, values + code_->pattern.entries(), 0.0);
  for (const ProgramCode::DirectEntry& entry : code_->direct_entries)
    values[entry.position] += slots[entry.slot];
  for (const ProgramCode::RowCoupling& coupling : code_->row_couplings) {
    const Eigen::MatrixXd& dz_dx = workspace.dz_dx_[coupling.loop];
    for (Eigen::Index k = 0; k < dz_dx.cols(); ++k) {
      values[code_->row_positions[coupling.first_position + static_cast<std::size_t>(k)]] +=
          slots[coupling.slot] * dz_dx(coupling.unknown, k);
    }
  }
  complete_jacobian(t, x, values, workspace);
  return true;
}

Workspace::Workspace(const Program& program)
    : program_(&program),
      first_discrete_state_(program.code_->first_discrete_state),
      slots_(program.initial_slots_) {
  for (std::size_t l = 0; l < program.code_->loop_codes.size(); ++l) {
    const std::size_t size = program.code_->loop_codes[l].size();
    loops_.emplace_back(size);
    dz_dx_.emplace_back(static_cast<Eigen::Index>(size),
                        static_cast<Eigen::Index>(program.code_->sensitivities[l].states.size()));
    dz_dt_.emplace_back(static_cast<Eigen::Index>(size), 1);
  }
  reset();
  reset_discrete_states();
}

void Workspace::set_unknown(std::size_t u, double value) {
  ++generation_;
  solved_[u] = value;
  slots_[1 + program_->n_states() + u] = value;
}

std::size_t Workspace::loop_evaluations() const {
  return std::accumulate(loops_.begin(), loops_.end(), std::size_t{0},
                         [](std::size_t sum, const LoopWorkspace& loop) { return sum + loop.evaluations(); });
}

void Workspace::follow_branches(bool follow) {
  for (LoopWorkspace& loop : loops_) loop.follow_branch(follow);
}

void Workspace::hold_loop(std::size_t loop, double t, const std::vector<double>& unknowns, bool whatever) {
  const Loop& members = program_->code_->loops[loop];
  for (std::size_t i = 0; i < unknowns.size(); ++i) set_unknown(members.unknowns[i], unknowns[i]);
  loops_[loop].hold(t, unknowns, whatever);
}

std::span<const double> Workspace::discrete_states() const {
  return std::span(slots_).subspan(first_discrete_state_, program_->code_->discrete_states.size());
}

void Workspace::load_discrete_states(std::span<const double> discrete_states) {
  ++generation_;
  std::copy(discrete_states.begin(), discrete_states.end(),
            slots_.begin() + static_cast<std::ptrdiff_t>(first_discrete_state_));
}

void Workspace::reset_discrete_states() {
  for (std::size_t m = 0; m < program_->code_->discrete_states.size(); ++m)
    set_discrete_state(m, program_->code_->discrete_states[m].start);
}

void Workspace::reset() {
  ++generation_;
  solved_.clear();
  for (const Unknown& unknown : program_->code_->unknowns) solved_.push_back(unknown.guess);
  std::copy(solved_.begin(), solved_.end(),
            slots_.begin() + static_cast<std::ptrdiff_t>(1 + program_->n_states()));
  for (LoopWorkspace& loop : loops_) loop.reset();
  trouble_ = {};
}

}  // namespace oblique::network
