// SPDX-License-Identifier: MIT
#include <oblique/machine/input_weight.h>

#include <algorithm>
#include <cmath>

namespace oblique::machine {
namespace {

/// What a weight may exceed a gain by: the rounding of the products that it comes from.
constexpr double kRounding = 1e-12;

}  // namespace

InputWeight split_weight(double weight, std::span<const double> gains) {
  if (gains.empty()) return {1, weight, 1};
  const auto fits = [&](double gain) { return weight <= gain * (1 + kRounding); };
  const auto enough = std::find_if(gains.begin(), gains.end(), fits);
  InputWeight split;
  split.gain = enough == gains.end() ? gains.back() : *enough;
  split.inputs = std::max(1, static_cast<int>(std::ceil(weight / split.gain * (1 - kRounding))));
  split.setting = weight / (split.inputs * split.gain);
  if (std::abs(split.setting - 1) <= kRounding) split.setting = 1;
  return split;
}

double choose_rate(double largest, double own, std::span<const double> rates, std::span<const double> gains) {
  const double most = gains.empty() ? 1 : gains.back();
  const auto suffices = [&](double rate) { return largest <= rate * most * (1 + kRounding); };
  const auto found = std::find_if(rates.begin(), rates.end(), suffices);
  if (found != rates.end()) return *found;
  constexpr double kSmall = 0.01;  // of an input: a setting that is hardly one
  if (suffices(own) && (own <= 1 || largest >= kSmall * own)) return own;
  const double least = std::pow(10, std::ceil(std::log10(largest / most * (1 - kRounding))));
  return suffices(own) ? std::max(1.0, least) : least;
}

}  // namespace oblique::machine
