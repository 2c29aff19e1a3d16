// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <oblique/machine/signal_ranges.h>
#include <oblique/text/expression.h>

// Not installed.
namespace oblique::machine {

/// constant + Σ weight · signal, of the signals of a TimeCircuit.
struct TimeSum {
  struct Term {
    double weight = 1;
    std::size_t signal = 0;
    bool operator==(const Term&) const = default;
  };
  double constant = 0;
  std::vector<Term> terms;
  bool operator==(const TimeSum&) const = default;
};

/// A signal that a machine draws of the time t [s] by a circuit of its own.
struct TimeSignal {
  enum class Kind {
    clock,        ///< t
    sine,         ///< exp(growth·t) sin(rate·t + phase), rate > 0
    exponential,  ///< exp(growth·t)
    product,      ///< a·b
    comparison,   ///< 1 where a > 0, else 0
    function,     ///< `function` of x = a
  };
  Kind kind = Kind::clock;
  double rate = 0, phase = 0, growth = 0;  ///< [1/s, rad, 1/s]
  TimeSum a, b;
  text::Expression function;
  SignalRange range = {};  ///< of a function's argument
};

/// A formula of the time as signals, each made of those before it, and their sum.
struct TimeCircuit {
  std::vector<TimeSignal> signals;
  TimeSum out;
  /// How much larger than what becomes of them signals are, at the most: the factors of a product than the
  /// product, the terms of a sum than the sum, an exponential at its end than at its start.
  double excess = 1;
  bool turns = false;  ///< whether there is a sine in it, or a comparison
};

/// Takes a formula of `time` and of numbers apart, for a run of `until` [s]. Sums with constant weights stay
/// sums; sines and exponentials of what is linear in time, products, powers to 4 and conditions become
/// circuits; what else there is of these, such as a root, becomes a function of one signal, and so does a
/// part that is no more than a smooth function of the time. Nothing where the whole is no more than that,
/// where two signals meet in something else, or where one is not finite.
std::optional<TimeCircuit> time_circuit(const text::Expression& formula, double until);

}  // namespace oblique::machine
