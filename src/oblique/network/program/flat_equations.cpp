// SPDX-License-Identifier: MIT
#include <oblique/network/program/flat_equations.h>

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include <oblique/network/program/program_code.h>

namespace oblique::network {
namespace {

constexpr std::uint32_t kNoSlot = std::numeric_limits<std::uint32_t>::max();

/// The tape in the order in which an evaluation of everything runs it.
std::vector<Instruction> in_order(const ProgramCode& code) {
  std::vector<Instruction> all;
  const auto add = [&](TapeRange range) {
    all.insert(all.end(), code.tape.begin() + range.begin, code.tape.begin() + range.end);
  };
  for (const auto* steps : {&code.derivative_steps, &code.event_function_steps, &code.signal_steps}) {
    for (const ProgramCode::Step& step : *steps) {
      add(step.segment);
      if (step.loop) add(code.loop_codes[*step.loop].body);
    }
  }
  add(code.jacobian_segment);
  return all;
}

/// Takes out of a tape what some slots need.
class Extraction {
 public:
  Extraction(const std::vector<Instruction>& tape, std::size_t n_slots)
      : tape_(tape), writer_(n_slots, kNoSlot) {
    for (std::uint32_t i = 0; i < tape.size(); ++i) writer_[tape[i].result] = i;
  }

  /// The instructions that these slots need, in the order of the tape, without those `done`, which are
  /// marked.
  std::vector<Instruction> needed_by(std::span<const std::uint32_t> slots, std::vector<bool>& done) const {
    std::vector<bool> mine(tape_.size());
    std::vector<std::uint32_t> pending(slots.begin(), slots.end());
    while (!pending.empty()) {
      const std::uint32_t i = writer_[pending.back()];
      pending.pop_back();
      if (i == kNoSlot || done[i] || mine[i]) continue;
      mine[i] = true;
      const int operands = operand_count(tape_[i].code);
      pending.push_back(tape_[i].a);
      if (operands >= 2) pending.push_back(tape_[i].b);
      if (operands >= 3) pending.push_back(tape_[i].c);
    }
    std::vector<Instruction> found;
    for (std::uint32_t i = 0; i < tape_.size(); ++i) {
      if (!mine[i]) continue;
      done[i] = true;
      found.push_back(tape_[i]);
    }
    return found;
  }

 private:
  const std::vector<Instruction>& tape_;
  std::vector<std::uint32_t> writer_;  ///< of each slot
};

}  // namespace

FlatEquations flat_equations(const Program& program, std::span<const std::size_t> signals) {
  const ProgramCode& code = *program.code_;
  FlatEquations flat;
  const std::size_t n = flat.n_states = code.states.size();
  flat.initial_slots = program.initial_slots_;
  flat.start_slots = code.fixed_start_slots;
  flat.rate_slots = code.derivative_slots;
  for (const std::size_t s : signals) flat.output_slots.push_back(code.signal_slots[s]);

  // The unknowns of loops that derivatives need come behind the states, on slots that follow on them.
  std::vector<std::uint32_t> row_of(code.unknowns.size(), kNoSlot);
  for (const std::uint32_t l : code.sensitivity_order) {
    const LoopCode& loop = code.loop_codes[l];
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const auto u = static_cast<std::uint32_t>(loop.unknown_slots[i] - 1 - n);
      row_of[u] = static_cast<std::uint32_t>(n + flat.unknowns.size());
      flat.unknowns.push_back(u);
      flat.rate_slots.push_back(loop.residual_slots[i]);
    }
  }
  flat.n_variables = n + flat.unknowns.size();
  const auto row_in = [&](std::uint32_t loop, std::uint32_t place) {
    return row_of[code.loop_codes[loop].unknown_slots[place] - 1 - n];
  };

  std::int64_t column = 0;
  std::vector<std::uint32_t> row_at(code.pattern.entries()), column_at(code.pattern.entries());
  for (std::size_t k = 0; k < code.pattern.entries(); ++k) {
    while (static_cast<std::int64_t>(k) >= code.pattern.column_starts[static_cast<std::size_t>(column) + 1])
      ++column;
    row_at[k] = static_cast<std::uint32_t>(code.pattern.rows[k]);
    column_at[k] = static_cast<std::uint32_t>(column);
  }
  for (const ProgramCode::DirectEntry& entry : code.direct_entries)
    flat.jacobian.push_back({row_at[entry.position], column_at[entry.position], entry.slot});
  for (const ProgramCode::RowCoupling& coupling : code.row_couplings)
    flat.jacobian.push_back({coupling.row, row_in(coupling.loop, coupling.unknown), coupling.slot});
  for (const std::uint32_t l : code.sensitivity_order) {
    const ProgramCode::Sensitivity& sensitivity = code.sensitivities[l];
    for (const MatrixEntry& entry : sensitivity.direct)
      flat.jacobian.push_back({row_in(l, entry.row), sensitivity.states[entry.column], entry.slot});
    for (const MatrixEntry& entry : code.loop_codes[l].jacobian)
      flat.jacobian.push_back({row_in(l, entry.row), row_in(l, entry.column), entry.slot});
    for (const ProgramCode::Coupling& coupling : sensitivity.couplings) {
      for (const MatrixEntry& entry : coupling.entries)
        flat.jacobian.push_back({row_in(l, entry.row), row_in(coupling.loop, entry.column), entry.slot});
    }
  }
  for (const auto& [row, slot] : code.time_entries)
    flat.by_time.emplace_back(row < n ? row : row_of[row - n], slot);

  const std::vector<Instruction> tape = in_order(code);
  const Extraction extraction(tape, flat.initial_slots.size());
  std::vector<bool> done(tape.size());
  flat.rates = extraction.needed_by(flat.rate_slots, done);
  std::vector<std::uint32_t> derivative_slots;
  for (const MatrixEntry& entry : flat.jacobian) derivative_slots.push_back(entry.slot);
  for (const auto& [row, slot] : flat.by_time) derivative_slots.push_back(slot);
  flat.derivatives = extraction.needed_by(derivative_slots, done);
  std::vector<bool> none(tape.size());
  flat.outputs = extraction.needed_by(flat.output_slots, none);

  const auto check = [&](std::uint32_t slot) {
    const bool unknown = slot > n && slot <= n + code.unknowns.size();
    if (!unknown || row_of[slot - 1 - n] != kNoSlot) return;
    throw NetworkError({{},
                        fmt::format("an output follows '{}', of a loop that no state depends on",
                                    code.unknowns[slot - 1 - n].name),
                        {},
                        {}});
  };
  std::for_each(flat.output_slots.begin(), flat.output_slots.end(), check);
  for (const Instruction& i : flat.outputs) {
    const std::uint32_t operands[] = {i.a, i.b, i.c};
    std::for_each(operands, operands + operand_count(i.code), check);
  }
  return flat;
}

}  // namespace oblique::network
