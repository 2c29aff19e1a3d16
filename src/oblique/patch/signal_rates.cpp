// SPDX-License-Identifier: MIT
#include <oblique/patch/signal_rates.h>

#include <algorithm>
#include <cmath>

namespace oblique::patch {

LinearForm SignalRates::of(const LinearForm& form, Order order) const {
  LinearForm rate;
  for (const auto& [signal, weight] : form.weights) rate.add(rates_.at(signal).forms[order], weight);
  return rate;
}

double SignalRates::largest(const LinearForm& form, Order order) const {
  std::vector<double> sum;
  for (const auto& [signal, weight] : form.weights) {
    const std::vector<double>& exact = rates_.at(signal).exact[order];
    sum.resize(exact.size());
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += weight * exact[k];
  }
  double largest = 0;
  for (const double value : sum) largest = std::max(largest, std::abs(value));
  return largest;
}

}  // namespace oblique::patch
