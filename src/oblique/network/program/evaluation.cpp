// SPDX-License-Identifier: MIT
#include <oblique/network/program/evaluation.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <oblique/network/program/program.h>

namespace oblique::network {

Evaluation::Evaluation(const Program& program, Workspace& workspace)
    : program_(&program), workspace_(&workspace), generation_(workspace.generation_) {}

void Evaluation::check() const {
  if (generation_ != workspace_->generation_)
    throw std::logic_error("an evaluation was read after its workspace had been used for another");
}

double Evaluation::value(std::uint32_t slot) const {
  check();
  return workspace_->slots_[slot];
}

void Evaluation::derivatives(double* dxdt) const {
  check();
  program_->copy_derivatives(*workspace_, dxdt);
}

double Evaluation::compared_size(std::size_t s) const {
  return std::abs(value(program_->code_->compared_slots[s]));
}

std::optional<double> Evaluation::known_rate(std::size_t s) const {
  const auto& slot = program_->code_->rate_slots[s];
  return slot ? std::optional(value(*slot)) : std::nullopt;
}

bool Evaluation::pieces_meet(std::size_t s) const {
  constexpr double kMeet = 1e-9;  // a jump that is smaller is below any tolerance of a run
  const auto& pieces = program_->code_->pieces[s];
  return program_->code_->has_pieces[s] && std::all_of(pieces.begin(), pieces.end(), [&](const auto& pair) {
           const double a = value(pair.first), b = value(pair.second);
           return std::abs(a - b) <= kMeet * std::max({1.0, std::abs(a), std::abs(b)});
         });
}

bool Evaluation::condition(std::size_t event) const {
  return value(program_->code_->event_slots[event].condition) != 0;
}

bool Evaluation::phase_ends(std::size_t end) const {
  return value(program_->code_->phase_end_slots[end]) != 0;
}

double Evaluation::event_function_rates(const double* dxdt, double* values) const {
  check();
  const ProgramCode& program = *program_->code_;
  if (program.switches.empty()) return 0;
  // What this computes stands on slots of its own, and makes nothing stale.
  double* const slots = workspace_->slots_.data();
  std::copy(dxdt, dxdt + program.states.size(), slots + program.first_rate);
  for (const ProgramCode::RateStep& step : program.rate_steps) {
    run_tape(std::span(program.tape).subspan(step.segment.begin, step.segment.end - step.segment.begin),
             slots);
    if (!step.loop) continue;
    LoopWorkspace& loop = workspace_->loops_[*step.loop];
    Eigen::MatrixXd& rates = workspace_->dz_dt_[*step.loop];
    const bool regular = loop.matrix().factor(program.loop_codes[*step.loop], slots);
    for (std::size_t i = 0; i < step.right_sides.size(); ++i) {
      rates(static_cast<Eigen::Index>(i), 0) =
          regular ? -slots[step.right_sides[i]] : std::numeric_limits<double>::quiet_NaN();
    }
    if (regular) loop.matrix().solve(rates);
    for (std::size_t i = 0; i < step.rates.size(); ++i)
      slots[step.rates[i]] = rates(static_cast<Eigen::Index>(i), 0);
  }
  for (std::size_t s = 0; s < program.event_function_rate_slots.size(); ++s)
    values[s] = slots[program.event_function_rate_slots[s]];
  double fastest = 0;
  for (const std::uint32_t slot : program.phase_rate_slots)
    fastest = std::max(fastest, std::abs(slots[slot]));
  return fastest;
}

double SignalEvaluation::action_value(std::size_t event, std::size_t action) const {
  return value(program_->code_->event_slots[event].values[action]);
}

std::optional<double> SignalEvaluation::start_value(std::size_t state) const {
  const auto& slot = program_->code_->start_slots[state];
  return slot ? std::optional(value(*slot)) : std::nullopt;
}

Eigen::VectorXd SignalEvaluation::loop_residuals(std::size_t loop) const {
  const LoopCode& code = program_->code_->loop_codes[loop];
  Eigen::VectorXd residuals(static_cast<Eigen::Index>(code.size()));
  for (std::size_t i = 0; i < code.size(); ++i)
    residuals[static_cast<Eigen::Index>(i)] = value(code.residual_slots[i]);
  return residuals;
}

Eigen::MatrixXd SignalEvaluation::loop_jacobian(std::size_t loop) const {
  const LoopCode& code = program_->code_->loop_codes[loop];
  const auto n = static_cast<Eigen::Index>(code.size());
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(n, n);
  for (const MatrixEntry& entry : code.jacobian) jacobian(entry.row, entry.column) = value(entry.slot);
  return jacobian;
}

}  // namespace oblique::network
