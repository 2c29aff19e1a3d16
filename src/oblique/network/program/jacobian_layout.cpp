// SPDX-License-Identifier: MIT
#include <oblique/network/program/jacobian_layout.h>

#include <algorithm>
#include <map>

namespace oblique::network {
namespace {

/// dz/dx of a loop is −(dg/dz)⁻¹ (dg/dx + Σ dg/dz′ · dz′/dx) over the loops z′ solved before it.
void find_sensitivity(Compilation& c, std::size_t loop) {
  ProgramCode::Sensitivity& sensitivity = c.code.sensitivities[loop];
  c.code.sensitivity_order.push_back(static_cast<std::uint32_t>(loop));
  const Loop& members = c.network.loops[loop];
  std::map<std::uint32_t, std::vector<MatrixEntry>> couplings;
  for (std::size_t i = 0; i < members.unknowns.size(); ++i) {
    const auto row = static_cast<std::uint32_t>(i);
    for (const auto& [variable, node] : c.residual_gradients[members.unknowns[i]]) {
      const std::uint32_t slot = c.writer->slot(node);
      if (variable == 0) {
        const std::size_t row_of_all = c.network.states.size() + members.unknowns[i];
        c.code.time_entries.emplace_back(static_cast<std::uint32_t>(row_of_all), slot);
      } else if (c.is_state(variable)) {
        const auto state = static_cast<std::uint32_t>(c.state_of(variable));
        sensitivity.direct.push_back({row, state, slot});
        sensitivity.states.push_back(state);
      } else if (c.is_unknown(variable) && c.loop_of_unknown[c.unknown_of(variable)] != loop) {
        const std::size_t other = c.unknown_of(variable);
        couplings[c.loop_of_unknown[other]].push_back({row, c.place_in_loop[other], slot});
      }
    }
  }
  for (const auto& [other, entries] : couplings) {
    const auto& states = c.code.sensitivities[other].states;
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
    ProgramCode::Coupling coupling{other, std::move(entries), {}};
    for (const std::uint32_t state : c.code.sensitivities[other].states) {
      coupling.targets.push_back(column_of(state));
    }
    sensitivity.couplings.push_back(std::move(coupling));
  }
}

void find_sensitivities(Compilation& c) {
  c.code.sensitivities.resize(c.network.loops.size());
  for (std::size_t l = 0; l < c.network.loops.size(); ++l) {
    if (c.for_derivatives.loops[l]) find_sensitivity(c, l);
  }
}

}  // namespace

void lay_out_jacobian(Compilation& c) {
  find_sensitivities(c);
  const std::size_t n = c.network.states.size();
  // Rows of each column: the states a derivative depends on directly or through loops, and the diagonal.
  std::vector<std::vector<std::int64_t>> columns(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto row = static_cast<std::int64_t>(i);
    columns[i].push_back(row);
    for (const auto& [variable, node] : c.state_gradients[i]) {
      if (c.is_state(variable)) columns[c.state_of(variable)].push_back(row);
      if (!c.is_unknown(variable)) continue;
      const auto& states = c.code.sensitivities[c.loop_of_unknown[c.unknown_of(variable)]].states;
      for (const std::uint32_t state : states) columns[state].push_back(row);
    }
  }
  SparsePattern& pattern = c.code.pattern;
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
    for (const auto& [variable, node] : c.state_gradients[i]) {
      const std::uint32_t slot = c.writer->slot(node);
      if (variable == 0) c.code.time_entries.emplace_back(static_cast<std::uint32_t>(i), slot);
      if (c.is_state(variable)) c.code.direct_entries.push_back({position(i, c.state_of(variable)), slot});
      if (!c.is_unknown(variable)) continue;
      const std::uint32_t loop = c.loop_of_unknown[c.unknown_of(variable)];
      const auto first = static_cast<std::uint32_t>(c.code.row_positions.size());
      for (const std::uint32_t state : c.code.sensitivities[loop].states) {
        c.code.row_positions.push_back(position(i, state));
      }
      c.code.row_couplings.push_back(
          {static_cast<std::uint32_t>(i), loop, c.place_in_loop[c.unknown_of(variable)], slot, first});
    }
  }
}

}  // namespace oblique::network
