// SPDX-License-Identifier: MIT
#include <oblique/solve/readings/driving_states.h>

namespace oblique::solve {

std::vector<bool> with_driving_states(const network::SparsePattern& jacobian, std::vector<bool> these) {
  std::vector<std::vector<std::size_t>> acts_on_row(jacobian.size());
  for (std::size_t column = 0; column < jacobian.size(); ++column) {
    for (auto k = jacobian.column_starts[column]; k < jacobian.column_starts[column + 1]; ++k)
      acts_on_row[static_cast<std::size_t>(jacobian.rows[static_cast<std::size_t>(k)])].push_back(column);
  }
  std::vector<std::size_t> pending;
  for (std::size_t i = 0; i < these.size(); ++i) {
    if (these[i]) pending.push_back(i);
  }
  while (!pending.empty()) {
    const std::size_t row = pending.back();
    pending.pop_back();
    for (const std::size_t column : acts_on_row[row]) {
      if (these[column]) continue;
      these[column] = true;
      pending.push_back(column);
    }
  }
  return these;
}

}  // namespace oblique::solve
