// SPDX-License-Identifier: MIT
#include <oblique/text/interval.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <oblique/text/noise.h>

namespace oblique::text {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Interval kLine{-kInfinity, kInfinity};

Interval product(const Interval& x, const Interval& y) {
  // Zero times a bound that is not known is zero: the bound is of numbers.
  const auto times = [](double a, double b) { return a == 0 || b == 0 ? 0.0 : a * b; };
  return hull({times(x.low, y.low), times(x.low, y.high), times(x.high, y.low), times(x.high, y.high)});
}

Interval quotient(const Interval& x, const Interval& y) {
  if (y.contains(0)) return kLine;
  return product(x, {1 / y.high, 1 / y.low});
}

Interval power(const Interval& x, const Interval& y) {
  if (y.is_point() && y.low == std::floor(y.low) && std::abs(y.low) < 1e9) {
    const Interval ends = hull({std::pow(x.low, y.low), std::pow(x.high, y.low)});
    if (!x.contains(0)) return ends;
    if (y.low < 0) return kLine;
    return std::fmod(y.low, 2) == 0 ? Interval{0, ends.high} : ends;
  }
  if (x.low < 0) return kLine;
  // Monotone in each of the two.
  return hull(
      {std::pow(x.low, y.low), std::pow(x.low, y.high), std::pow(x.high, y.low), std::pow(x.high, y.high)});
}

/// sin over x + shift.
Interval sine(const Interval& x, double shift) {
  if (!std::isfinite(x.low) || !std::isfinite(x.high) || x.width() >= 2 * std::numbers::pi) return {-1, 1};
  Interval result =
      shift == 0 ? hull({std::sin(x.low), std::sin(x.high)}) : hull({std::cos(x.low), std::cos(x.high)});
  // Whether π/2 + 2πk, or −π/2 + 2πk, lies within.
  const auto passes = [&](double at) {
    const double turn = 2 * std::numbers::pi;
    return std::floor((x.high + shift - at) / turn) > std::floor((x.low + shift - at) / turn);
  };
  if (passes(std::numbers::pi / 2)) result.high = 1;
  if (passes(-std::numbers::pi / 2)) result.low = -1;
  return result;
}

Interval tangent(const Interval& x) {
  const double half_turn = std::numbers::pi;
  if (!(x.width() < half_turn) || std::floor(x.low / half_turn + 0.5) != std::floor(x.high / half_turn + 0.5))
    return kLine;
  return hull({std::tan(x.low), std::tan(x.high)});
}

/// Of the vectors (x, y): from one corner of their rectangle to another, unless the angle jumps within it, as
/// it does where y falls below zero on the left, and anywhere about the origin.
Interval angle(const Interval& y, const Interval& x) {
  const bool jumps = y.low < 0 && y.high >= 0 && x.low <= 0;
  if (jumps) return {-std::numbers::pi, std::numbers::pi};
  return hull({std::atan2(y.low, x.low), std::atan2(y.low, x.high), std::atan2(y.high, x.low),
               std::atan2(y.high, x.high)});
}

Interval magnitude(const Interval& x) {
  const Interval ends = hull({std::abs(x.low), std::abs(x.high)});
  return x.contains(0) ? Interval{0, ends.high} : ends;
}

Interval sampled_noise(const Interval& x, const Interval& seed, int derivative) {
  constexpr double kLargest = 14;  // of the noise: eight standard deviations of its knots
  constexpr double kNarrow = 0.25;
  if (!seed.is_point()) return kLine;
  if (x.is_point()) return hull({noise(x.low, seed.low, derivative)});
  if (!(x.width() < kNarrow)) return {-2 * kLargest, 2 * kLargest};
  const double middle = x.low + x.width() / 2;
  const Interval seen = hull({noise(x.low, seed.low, derivative), noise(middle, seed.low, derivative),
                              noise(x.high, seed.low, derivative)});
  return {seen.low - seen.width() / 4, seen.high + seen.width() / 4};
}

/// A function that rises, within the arguments that it has values for.
template <class Rising>
Interval rising(const Rising& function, Interval x, double least = -kInfinity, double most = kInfinity) {
  if (x.low < least || x.high > most) return kLine;
  return hull({function(x.low), function(x.high)});
}

}  // namespace

Interval hull(std::initializer_list<double> values) {
  if (std::any_of(values.begin(), values.end(), [](double v) { return std::isnan(v); })) return kLine;
  return {std::min(values), std::max(values)};
}

Interval square(const Interval& x) {
  const Interval ends = hull({x.low * x.low, x.high * x.high});
  return x.contains(0) ? Interval{0, ends.high} : ends;
}

Interval evaluate(Operation operation, const Interval& a, const Interval& b) {
  switch (operation) {
    case Operation::add:
      return hull({a.low + b.low, a.high + b.high});
    case Operation::subtract:
      return hull({a.low - b.high, a.high - b.low});
    case Operation::multiply:
      return product(a, b);
    case Operation::divide:
      return quotient(a, b);
    case Operation::power:
      return power(a, b);
    case Operation::negate:
      return {-a.high, -a.low};
    case Operation::sin:
      return sine(a, 0);
    case Operation::cos:
      return sine(a, std::numbers::pi / 2);
    case Operation::tan:
      return tangent(a);
    case Operation::asin:
      return rising([](double x) { return std::asin(x); }, a, -1, 1);
    case Operation::acos:
      return rising([](double x) { return std::acos(x); }, a, -1, 1);
    case Operation::atan:
      return rising([](double x) { return std::atan(x); }, a);
    case Operation::atan2:
      return angle(a, b);
    case Operation::exp:
      return rising([](double x) { return std::exp(x); }, a);
    case Operation::log:
      return rising([](double x) { return std::log(x); }, a, 0);
    case Operation::sqrt:
      return rising([](double x) { return std::sqrt(x); }, a, 0);
    case Operation::hypot: {
      const Interval x = magnitude(a), y = magnitude(b);
      return {std::hypot(x.low, y.low), std::hypot(x.high, y.high)};
    }
    case Operation::noise:
      return sampled_noise(a, b, 0);
    case Operation::noise_derivative:
      return sampled_noise(a, b, 1);
  }
  return kLine;
}

}  // namespace oblique::text
