// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include <oblique/patch/linear_form.h>

namespace oblique::patch {

/// The rates of signals by time: as forms of further signals, in machine units of velocity and acceleration,
/// and as they are along the exact motion.
class SignalRates {
 public:
  enum Order : std::size_t { first, second };

  struct Rates {
    std::array<LinearForm, 2> forms;
    std::array<std::vector<double>, 2>
        exact;  ///< in each row of the motion [machine unit/s], [machine unit/s²]
  };

  /// Of one signal, to be filled.
  Rates& operator[](const std::string& signal) { return rates_[signal]; }

  /// The rate of a form whose signals all have theirs.
  LinearForm of(const LinearForm& form, Order order) const;

  /// Its largest magnitude along the exact motion [machine unit/s], [machine unit/s²].
  double largest(const LinearForm& form, Order order) const;

 private:
  std::map<std::string, Rates> rates_;
};

}  // namespace oblique::patch
