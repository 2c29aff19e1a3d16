// SPDX-License-Identifier: MIT
#include <oblique/network/program/program.h>

#include <algorithm>
#include <cmath>

#include <oblique/network/program/program_compiler.h>

namespace oblique::network {

Program::Program(Network network) {
  ProgramCompiler(*this, std::move(network)).compile();
}

std::vector<double> Program::start() const {
  std::vector<double> x;
  x.reserve(states_.size());
  for (const State& state : states_) x.push_back(state.start);
  return x;
}

bool Program::run(const std::vector<Step>& steps, Workspace& workspace) const {
  double* const slots = workspace.slots_.data();
  const std::span<const Instruction> tape(tape_);
  const std::size_t first_unknown = 1 + states_.size();
  for (const Step& step : steps) {
    run_tape(tape.subspan(step.stretch.begin, step.stretch.end - step.stretch.begin), slots);
    if (!step.loop) continue;
    const LoopCode& loop = loop_codes_[*step.loop];
    const LoopFailure failure = workspace.loops_[*step.loop].solve_loop(loop, tape, slots);
    if (failure != LoopFailure::none) {
      const double slope = loop.size() == 1 && !loop.slopes.empty() ? slots[loop.slopes[0].slot] : 0;
      workspace.trouble_ = {*step.loop, failure, slope,
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
  std::copy(x, x + states_.size(), workspace.slots_.begin() + 1);
  return run(derivative_steps_, workspace);
}

bool Program::derivatives(double t, const double* x, double* dxdt, Workspace& workspace) const {
  if (!load_and_run(t, x, workspace)) return false;
  copy_derivatives(workspace, dxdt);
  return true;
}

void Program::copy_derivatives(const Workspace& workspace, double* dxdt) const {
  for (std::size_t i = 0; i < derivative_slots_.size(); ++i) dxdt[i] = workspace.slots_[derivative_slots_[i]];
}

std::optional<SignalEvaluation> Program::signals(double t, const double* x, double* values,
                                                 Workspace& workspace) const {
  if (!load_and_run(t, x, workspace) || !run(surface_steps_, workspace) || !run(signal_steps_, workspace))
    return std::nullopt;
  for (std::size_t i = 0; i < signal_slots_.size(); ++i) values[i] = workspace.slots_[signal_slots_[i]];
  return SignalEvaluation(*this, workspace);
}

std::optional<Evaluation> Program::surfaces(double t, const double* x, double* values,
                                            Workspace& workspace) const {
  if (!load_and_run(t, x, workspace) || !run(surface_steps_, workspace)) return std::nullopt;
  for (std::size_t i = 0; i < surface_slots_.size(); ++i) values[i] = workspace.slots_[surface_slots_[i]];
  return Evaluation(*this, workspace);
}

void Program::decide_in_order(double t, const double* x, const double* dxdt, Workspace& workspace,
                              const Decide& decide) const {
  ++workspace.generation_;
  double* const slots = workspace.slots_.data();
  slots[0] = t;
  std::copy(x, x + states_.size(), slots + 1);
  std::copy(dxdt, dxdt + states_.size(), slots + first_rate_);
  for (const auto& [stretch, s] : switch_order_) {
    run_tape(std::span(tape_).subspan(stretch.begin, stretch.end - stretch.begin), slots);
    decide(s, slots[surface_slots_[s]], slots[surface_rate_slots_[s]]);
  }
}

std::vector<Interval> Program::source_slots() const {
  std::vector<Interval> slots;
  if (sources_.empty()) return slots;
  slots.reserve(initial_slots_.size());
  for (const double value : initial_slots_) slots.push_back({value, value});
  return slots;
}

void Program::source_ranges(const Interval& time, std::span<const Interval> states,
                            const Workspace& workspace, std::span<Interval> slots) const {
  slots[0] = time;
  for (std::size_t k = 0; k < states.size(); ++k) slots[1 + source_states_[k]] = states[k];
  for (std::size_t m = first_memory_; m < first_memory_ + memories_.size(); ++m)
    slots[m] = {workspace.slots_[m], workspace.slots_[m]};
  run_tape(std::span(tape_).subspan(source_stretch_.begin, source_stretch_.end - source_stretch_.begin),
           slots);
}

bool Program::derivatives_need(std::size_t loop) const {
  return std::any_of(derivative_steps_.begin(), derivative_steps_.end(),
                     [&](const Step& step) { return step.loop == loop; });
}

bool Program::differentiate_loops(Workspace& workspace) const {
  const double* const slots = workspace.slots_.data();
  for (const std::uint32_t l : sensitivity_order_) {
    const Sensitivity& sensitivity = sensitivities_[l];
    Eigen::MatrixXd& dz_dx = workspace.dz_dx_[l];
    dz_dx.setZero();
    for (const MatrixEntry& entry : sensitivity.direct) dz_dx(entry.row, entry.column) -= slots[entry.slot];
    for (const Coupling& coupling : sensitivity.couplings) {
      const Eigen::MatrixXd& other = workspace.dz_dx_[coupling.loop];
      for (const MatrixEntry& entry : coupling.entries) {
        for (std::size_t k = 0; k < coupling.targets.size(); ++k) {
          dz_dx(entry.row, coupling.targets[k]) -=
              slots[entry.slot] * other(entry.column, static_cast<Eigen::Index>(k));
        }
      }
    }
    if (!workspace.loops_[l].matrix().factor(loop_codes_[l], slots)) {
      const std::uint32_t first = loop_codes_[l].unknown_slots.front();
      workspace.trouble_ = {l, LoopFailure::singular, 0, slots[first]};
      return false;
    }
    workspace.loops_[l].matrix().solve(dz_dx);
  }
  return true;
}

bool Program::jacobian(double t, const double* x, double* values, Workspace& workspace) const {
  if (!load_and_run(t, x, workspace)) return false;
  double* const slots = workspace.slots_.data();
  run_tape(std::span(tape_).subspan(jacobian_stretch_.begin, jacobian_stretch_.end - jacobian_stretch_.begin),
           slots);
  if (!differentiate_loops(workspace)) return false;
  std::fill(values, values + pattern_.entries(), 0.0);
  for (const DirectEntry& entry : direct_entries_) values[entry.position] += slots[entry.slot];
  for (const RowCoupling& coupling : row_couplings_) {
    const Eigen::MatrixXd& dz_dx = workspace.dz_dx_[coupling.loop];
    for (Eigen::Index k = 0; k < dz_dx.cols(); ++k) {
      values[row_positions_[coupling.first_position + static_cast<std::size_t>(k)]] +=
          slots[coupling.slot] * dz_dx(coupling.unknown, k);
    }
  }
  return true;
}

Workspace::Workspace(const Program& program)
    : program_(&program), first_memory_(program.first_memory_), slots_(program.initial_slots_) {
  for (std::size_t l = 0; l < program.loop_codes_.size(); ++l) {
    const std::size_t size = program.loop_codes_[l].size();
    loops_.emplace_back(size);
    dz_dx_.emplace_back(static_cast<Eigen::Index>(size),
                        static_cast<Eigen::Index>(program.sensitivities_[l].states.size()));
    dz_dt_.emplace_back(static_cast<Eigen::Index>(size), 1);
  }
  reset();
  reset_memories();
}

void Workspace::set_unknown(std::size_t u, double value) {
  ++generation_;
  solved_[u] = value;
  slots_[1 + program_->n_states() + u] = value;
}

void Workspace::follow_branches(bool follow) {
  for (LoopWorkspace& loop : loops_) loop.follow_branch(follow);
}

void Workspace::hold_loop(std::size_t loop, double t, const std::vector<double>& unknowns, bool whatever) {
  const Loop& members = program_->loops_[loop];
  for (std::size_t i = 0; i < unknowns.size(); ++i) set_unknown(members.unknowns[i], unknowns[i]);
  loops_[loop].hold(t, unknowns, whatever);
}

std::span<const double> Workspace::memories() const {
  return std::span(slots_).subspan(first_memory_, program_->memories_.size());
}

void Workspace::load_memories(std::span<const double> memories) {
  ++generation_;
  std::copy(memories.begin(), memories.end(), slots_.begin() + static_cast<std::ptrdiff_t>(first_memory_));
}

void Workspace::reset_memories() {
  for (std::size_t m = 0; m < program_->memories_.size(); ++m) set_memory(m, program_->memories_[m].start);
}

void Workspace::reset() {
  ++generation_;
  solved_.clear();
  for (const Unknown& unknown : program_->unknowns_) solved_.push_back(unknown.guess);
  std::copy(solved_.begin(), solved_.end(),
            slots_.begin() + static_cast<std::ptrdiff_t>(1 + program_->n_states()));
  for (LoopWorkspace& loop : loops_) loop.reset();
  trouble_ = {};
}

}  // namespace oblique::network
