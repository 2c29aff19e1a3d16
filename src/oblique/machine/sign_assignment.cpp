// SPDX-License-Identifier: MIT
#include <oblique/machine/sign_assignment.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>

namespace oblique::machine {
namespace {

/// The present choice with what it costs, kept up to date flip by flip.
class Board {
 public:
  explicit Board(const SignProblem& problem)
      : problem_(problem),
        signals_of_(problem.variables),
        uses_of_(problem.variables),
        chosen_(problem.variables, false),
        negative_(problem.signals.size(), false),
        asked_(problem.signals.size(), {0, 0}),
        use_negative_(problem.uses.size()) {
    for (std::size_t s = 0; s < problem.signals.size(); ++s) {
      for (const auto& variable : problem.signals[s].variables) {
        if (variable) signals_of_[*variable].push_back(s);
      }
    }
    for (std::size_t u = 0; u < problem.uses.size(); ++u) {
      const SignProblem::Use& use = problem.uses[u];
      if (use.variable) uses_of_[*use.variable].push_back(u);
      use_negative_[u] = use.negative;
      ++asked(use.signal, use.negative);
    }
    for (std::size_t s = 0; s < problem.signals.size(); ++s) cost_ += cost_of(s);
  }

  std::int64_t cost() const { return cost_; }
  const std::vector<bool>& chosen() const { return chosen_; }

  void flip(std::size_t variable) {
    chosen_[variable] = !chosen_[variable];
    for (const std::size_t s : signals_of_[variable]) {
      cost_ -= cost_of(s);
      negative_[s] = !negative_[s];
      cost_ += cost_of(s);
    }
    for (const std::size_t u : uses_of_[variable]) {
      const std::size_t s = problem_.uses[u].signal;
      cost_ -= cost_of(s);
      --asked(s, use_negative_[u]);
      use_negative_[u] = !use_negative_[u];
      ++asked(s, use_negative_[u]);
      cost_ += cost_of(s);
    }
  }

  /// What a flip would cost.
  std::int64_t cost_after(std::size_t variable) {
    flip(variable);
    const std::int64_t cost = cost_;
    flip(variable);
    return cost;
  }

 private:
  int& asked(std::size_t signal, bool negative) { return asked_[signal][negative ? 1 : 0]; }

  /// An inverter outweighs all negatives together, which matter only to the reader.
  std::int64_t cost_of(std::size_t signal) {
    const auto inverter = static_cast<std::int64_t>(problem_.signals.size()) + 1;
    return (asked(signal, !negative_[signal]) > 0 ? inverter : 0) + (negative_[signal] ? 1 : 0);
  }

  const SignProblem& problem_;
  std::vector<std::vector<std::size_t>> signals_of_, uses_of_;  ///< of each variable
  std::vector<bool> chosen_;
  std::vector<bool> negative_;
  std::vector<std::array<int, 2>> asked_;  ///< uses of each signal, and of its negative
  std::vector<bool> use_negative_;
  std::int64_t cost_ = 0;
};

}  // namespace

SignChoice signs_of(const SignProblem& problem, std::vector<bool> variables) {
  SignChoice choice;
  choice.negative.assign(problem.signals.size(), false);
  choice.inverted.assign(problem.signals.size(), false);
  for (std::size_t s = 0; s < problem.signals.size(); ++s) {
    for (const auto& variable : problem.signals[s].variables) {
      if (variable && variables[*variable]) choice.negative[s] = !choice.negative[s];
    }
  }
  for (const SignProblem::Use& use : problem.uses) {
    const bool negative = use.negative != (use.variable && variables[*use.variable]);
    if (negative != choice.negative[use.signal]) choice.inverted[use.signal] = true;
  }
  choice.inverters =
      static_cast<std::size_t>(std::count(choice.inverted.begin(), choice.inverted.end(), true));
  choice.variables = std::move(variables);
  return choice;
}

SignChoice choose_signs(const SignProblem& problem) {
  const std::size_t n = problem.variables;
  if (n == 0) return signs_of(problem, {});
  // Enough for small networks to the last inverter; the bound keeps large ones within seconds.
  const std::size_t steps = std::min<std::size_t>(300 * n + 3000, 40'000'000 / n);
  const std::size_t patience = 20 * n;
  std::mt19937 random(1);  // always the same: a search that goes in circles finds nothing
  Board board(problem);
  std::vector<bool> best = board.chosen();
  std::int64_t least = board.cost();
  std::vector<std::size_t> free_at(n, 0);
  std::size_t improved = 0;
  for (std::size_t step = 1; step <= steps; ++step) {
    if (step - improved > patience) {  // somewhere else, then
      for (std::size_t k = 0; k <= n / 4; ++k) board.flip(random() % n);
      improved = step;
    }
    const std::size_t first = random() % n;  // so that none of those of equal cost is preferred
    std::optional<std::size_t> next;
    std::int64_t next_cost = std::numeric_limits<std::int64_t>::max();
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t variable = (k + first) % n;
      const std::int64_t cost = board.cost_after(variable);
      const bool allowed = free_at[variable] <= step || cost < least;
      if (allowed && cost < next_cost) {
        next = variable;
        next_cost = cost;
      }
    }
    if (!next) continue;
    board.flip(*next);
    free_at[*next] = step + 2 + random() % (n / 3 + 1);
    if (next_cost < least) {
      least = next_cost;
      best = board.chosen();
      improved = step;
    }
  }
  return signs_of(problem, std::move(best));
}

}  // namespace oblique::machine
