// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace oblique::machine {

/// Which signals a machine whose summers invert should carry as their negatives. Every variable is a choice
/// between two ways to run an element: of a summer, an integrator or an open amplifier the sign of all its
/// inputs and of its output; of a multiplier, which has two, the sign of one input and of its output.
struct SignProblem {
  /// A signal is carried as its negative where an odd number of its variables is chosen; without variables
  /// it is carried as it is.
  struct Signal {
    std::array<std::optional<std::size_t>, 2> variables;
  };
  /// An input asks for the negative of a signal where `negative` differs from the choice of its variable.
  struct Use {
    std::size_t signal = 0;
    bool negative = false;
    std::optional<std::size_t> variable;
  };
  std::size_t variables = 0;
  std::vector<Signal> signals;
  std::vector<Use> uses;
};

struct SignChoice {
  std::vector<bool> variables;
  std::vector<bool> negative;  ///< of each signal: how the element itself gives it
  std::vector<bool> inverted;  ///< of each signal: whether somebody asks for the other sign too
  std::size_t inverters = 0;   ///< how many are inverted
};

/// What a choice of the variables means.
SignChoice signs_of(const SignProblem& problem, std::vector<bool> variables);

/// The choice with the fewest inverters that a tabu search finds, and among those with few negatives; the
/// same at every call. For small networks the minimum is found (tests hold it against all choices); the
/// problem itself is hard.
SignChoice choose_signs(const SignProblem& problem);

}  // namespace oblique::machine
