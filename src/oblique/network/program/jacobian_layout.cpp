// SPDX-License-Identifier: MIT
// The part of ProgramCompiler that decides where every derivative goes.
#include <algorithm>
#include <limits>
#include <map>

#include <oblique/network/program/program_compiler.h>

namespace oblique::network {

void ProgramCompiler::find_sensitivities() {
  program_.sensitivities_.resize(network_.loops.size());
  for (std::size_t l = 0; l < network_.loops.size(); ++l) {
    if (for_derivatives_.loops[l]) find_sensitivity(l);
  }
}

/// dz/dx of a loop is −(dg/dz)⁻¹ (dg/dx + Σ dg/dz′ · dz′/dx) over the loops z′ solved before it.
void ProgramCompiler::find_sensitivity(std::size_t loop) {
  Program::Sensitivity& sensitivity = program_.sensitivities_[loop];
  program_.sensitivity_order_.push_back(static_cast<std::uint32_t>(loop));
  const Loop& members = network_.loops[loop];
  std::map<std::uint32_t, std::vector<MatrixEntry>> couplings;
  for (std::size_t i = 0; i < members.unknowns.size(); ++i) {
    const auto row = static_cast<std::uint32_t>(i);
    for (const auto& [variable, node] : residual_gradients_[members.unknowns[i]]) {
      const std::uint32_t slot = writer_->slot(node);
      if (is_state(variable)) {
        const auto state = static_cast<std::uint32_t>(state_of(variable));
        sensitivity.direct.push_back({row, state, slot});
        sensitivity.states.push_back(state);
      } else if (is_unknown(variable) && loop_of_unknown_[unknown_of(variable)] != loop) {
        const std::size_t other = unknown_of(variable);
        couplings[loop_of_unknown_[other]].push_back({row, place_in_loop_[other], slot});
      }
    }
  }
  for (const auto& [other, entries] : couplings) {
    const auto& states = program_.sensitivities_[other].states;
    sensitivity.states.insert(sensitivity.states.end(), states.begin(), states.end());
  }
  std::sort(sensitivity.states.begin(), sensitivity.states.end());
  sensitivity.states.erase(std::unique(sensitivity.states.begin(), sensitivity.states.end()),
                           sensitivity.states.end());
  const auto column_of = [&](std::uint32_t state) {
    const auto found = std::lower_bound(sensitivity.states.begin(), sensitivity.states.end(), state);
    return static_cast<std::uint32_t>(found - sensitivity.states.begin());
  };
  for (MatrixEntry& entry : sensitivity.direct) entry.column = column_of(entry.column);
  for (auto& [other, entries] : couplings) {
    Program::Coupling coupling{other, std::move(entries), {}};
    for (const std::uint32_t state : program_.sensitivities_[other].states) {
      coupling.targets.push_back(column_of(state));
    }
    sensitivity.couplings.push_back(std::move(coupling));
  }
}

void ProgramCompiler::lay_out_jacobian() {
  const std::size_t n = network_.states.size();
  // Rows of each column: the states a derivative depends on directly or through loops, and the diagonal.
  std::vector<std::vector<std::int64_t>> columns(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto row = static_cast<std::int64_t>(i);
    columns[i].push_back(row);
    for (const auto& [variable, node] : state_gradients_[i]) {
      if (is_state(variable)) columns[state_of(variable)].push_back(row);
      if (!is_unknown(variable)) continue;
      const auto& states = program_.sensitivities_[loop_of_unknown_[unknown_of(variable)]].states;
      for (const std::uint32_t state : states) columns[state].push_back(row);
    }
  }
  SparsePattern& pattern = program_.pattern_;
  for (auto& rows : columns) {
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    pattern.rows.insert(pattern.rows.end(), rows.begin(), rows.end());
    pattern.column_starts.push_back(static_cast<std::int64_t>(pattern.rows.size()));
  }
  const auto position = [&](std::size_t row, std::size_t column) {
    const auto begin = pattern.rows.begin() + pattern.column_starts[column];
    const auto end = pattern.rows.begin() + pattern.column_starts[column + 1];
    return static_cast<std::uint32_t>(std::lower_bound(begin, end, static_cast<std::int64_t>(row)) -
                                      pattern.rows.begin());
  };
  for (std::size_t i = 0; i < n; ++i) {
    for (const auto& [variable, node] : state_gradients_[i]) {
      const std::uint32_t slot = writer_->slot(node);
      if (is_state(variable)) program_.direct_entries_.push_back({position(i, state_of(variable)), slot});
      if (!is_unknown(variable)) continue;
      const std::uint32_t loop = loop_of_unknown_[unknown_of(variable)];
      const auto first = static_cast<std::uint32_t>(program_.row_positions_.size());
      for (const std::uint32_t state : program_.sensitivities_[loop].states) {
        program_.row_positions_.push_back(position(i, state));
      }
      program_.row_couplings_.push_back({loop, place_in_loop_[unknown_of(variable)], slot, first});
    }
  }
}

}  // namespace oblique::network
