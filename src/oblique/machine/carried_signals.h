// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <oblique/diagram/machine_profile.h>
#include <oblique/machine/circuit.h>
#include <oblique/machine/sign_assignment.h>

namespace oblique::machine {

/// Whether weights on the machine may be negative, so that nothing needs an inverter.
bool has_signed_weights(const diagram::MachineProfile& machine);

/// The signals of a circuit on a machine: which are carried as their negatives, where inverters stand, and
/// what everything is called. The circuit must outlive it.
class CarriedSignals {
 public:
  CarriedSignals(const Circuit& circuit, const diagram::MachineProfile& machine);

  /// What the weights of an input are to be multiplied by: for the sign of what the element gives and
  /// whether it inverts on the machine, and, of what an integrator adds up, its rate [1/s].
  double input_factor(std::size_t index, std::size_t port) const;

  /// Whether the element itself gives the negative of its signal.
  bool is_negative(std::size_t element) const { return signs_.negative[first_signal_[element]]; }
  /// The sign with which a meter sees a signal without an inverter.
  bool is_negative(diagram::SignalRef signal) const { return signs_.negative[index_of(signal)]; }

  const std::string& name(std::size_t element) const { return names_[element]; }
  /// The inverters behind an element: the name of each, and of what it inverts.
  std::vector<std::pair<std::string, std::string>> inverters(std::size_t element);
  std::size_t inverter_count() const { return signs_.inverters; }

  /// The name under which a signal, or its negative, is to be had; of the reference without a signal.
  std::string source(const std::optional<diagram::SignalRef>& signal, bool negative);
  /// The names of +1 and −1 machine unit, empty while nobody has asked for them.
  const std::array<std::string, 2>& references() const { return references_; }

  /// `path` as the name of a block, or the next one that is free; it is then taken.
  std::string free_name(std::string path);

 private:
  /// The factor of an input where its variable is not chosen; it is the negative where it is.
  struct Orientation {
    double factor = 1;
    std::optional<std::size_t> variable;
  };
  Orientation orientation(std::size_t index, std::size_t port) const;
  SignProblem problem();
  void choose_names();
  std::string output_name(diagram::SignalRef signal) const;
  std::size_t index_of(diagram::SignalRef signal) const {
    return first_signal_[signal.block] + signal.output;
  }

  const Circuit& circuit_;
  double polarity_;                                         ///< of the machine's summers and integrators
  std::vector<std::size_t> first_variable_, first_signal_;  ///< of each element, in the problem of signs
  SignChoice signs_;
  std::set<std::string> taken_;
  std::vector<std::string> names_;              ///< of each element
  std::map<std::size_t, std::string> inverse_;  ///< by signal: the inverter behind it
  std::array<std::string, 2> references_;
};

}  // namespace oblique::machine
