// SPDX-License-Identifier: MIT
#include <oblique/ensemble/study/combinations.h>

#include <limits>
#include <utility>

namespace oblique::ensemble {

std::optional<std::uint64_t> grid_size(std::span<const Levels> levels) {
  std::uint64_t size = 1;
  for (const Levels& one : levels) {
    if (size > std::numeric_limits<std::uint64_t>::max() / one.grid().size()) return std::nullopt;
    size *= one.grid().size();
  }
  return size;
}

Combinations::Combinations(std::vector<Levels> levels, Sampling sampling, std::optional<std::uint64_t> runs,
                           std::uint64_t seed)
    : levels_(std::move(levels)), sampling_(sampling), repeats_(runs.value_or(1)), runs_(repeats_) {
  if (sampling_ == Sampling::grid) runs_ *= grid_size(levels_).value_or(0);
  if (sampling_ == Sampling::latin_hypercube)
    hypercube_.emplace(seed, static_cast<std::uint32_t>(runs_), levels_.size());
}

void Combinations::values(std::uint64_t number, std::span<double> values) const {
  if (sampling_ == Sampling::grid) {
    std::uint64_t rest = number / repeats_;
    for (std::size_t k = levels_.size(); k-- > 0;) {
      const std::vector<double>& grid = levels_[k].grid();
      values[k] = grid[rest % grid.size()];
      rest /= grid.size();
    }
    return;
  }
  const auto point = static_cast<std::uint32_t>(number);
  for (std::size_t k = 0; k < levels_.size(); ++k)
    values[k] = levels_[k].at(hypercube_ ? hypercube_->at(point, k) : sobol(point, k));
}

}  // namespace oblique::ensemble
