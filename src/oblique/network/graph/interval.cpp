// SPDX-License-Identifier: MIT
#include <oblique/network/graph/interval.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <numbers>

#include <oblique/text/noise.h>
#include <oblique/text/operations.h>

namespace oblique::network {
namespace {

using Code = Instruction::Code;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Interval kLine{-kInfinity, kInfinity};

Interval hull(std::initializer_list<double> values) {
  if (std::any_of(values.begin(), values.end(), [](double v) { return std::isnan(v); })) return kLine;
  return {std::min(values), std::max(values)};
}

bool is_point(const Interval& x) {
  return x.low == x.high;
}

Interval product(const Interval& x, const Interval& y) {
  // Zero times a bound that is not known is zero: the bound is of numbers.
  const auto times = [](double a, double b) { return a == 0 || b == 0 ? 0.0 : a * b; };
  return hull({times(x.low, y.low), times(x.low, y.high), times(x.high, y.low), times(x.high, y.high)});
}

Interval square(const Interval& x) {
  const Interval ends = hull({x.low * x.low, x.high * x.high});
  return x.contains(0) ? Interval{0, ends.high} : ends;
}

Interval quotient(const Interval& x, const Interval& y) {
  if (y.contains(0)) return kLine;
  return product(x, {1 / y.high, 1 / y.low});
}

Interval power(const Interval& x, const Interval& y) {
  if (is_point(y) && y.low == std::floor(y.low) && std::abs(y.low) < 1e9) {
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
  if (!is_point(seed)) return kLine;
  if (is_point(x)) return hull({text::noise(x.low, seed.low, derivative)});
  if (!(x.width() < kNarrow)) return {-2 * kLargest, 2 * kLargest};
  const double middle = x.low + x.width() / 2;
  const Interval seen =
      hull({text::noise(x.low, seed.low, derivative), text::noise(middle, seed.low, derivative),
            text::noise(x.high, seed.low, derivative)});
  return {seen.low - seen.width() / 4, seen.high + seen.width() / 4};
}

/// A function that rises, within the arguments that it has values for.
template <class Rising>
Interval rising(const Rising& function, Interval x, double least = -kInfinity, double most = kInfinity) {
  if (x.low < least || x.high > most) return kLine;
  return hull({function(x.low), function(x.high)});
}

Interval truth(bool surely, bool surely_not) {
  return {surely ? 1.0 : 0.0, surely_not ? 0.0 : 1.0};
}

/// The straight line of one segment of a table, or its slope; the whole line where the segment is not known.
/// A table on slots is the number of its points, then for each segment its begin, the value there, the slope.
Interval table_range(const Instruction& i, std::span<const Interval> slots) {
  const bool slope_asked = i.code == Code::table_slope;
  const Interval segment = slots[slope_asked ? i.a : i.b];
  if (!is_point(segment) || (!slope_asked && i.code != Code::table_value)) return kLine;
  const std::size_t table = slope_asked ? i.b : i.c;
  const double last = slots[table].low - 2;
  const auto at = table + 1 + 3 * static_cast<std::size_t>(std::clamp(segment.low, 0.0, last));
  const double begin = slots[at].low, value = slots[at + 1].low, slope = slots[at + 2].low;
  if (slope_asked) return {slope, slope};
  const Interval x = slots[i.a];
  return hull({value + slope * (x.low - begin), value + slope * (x.high - begin)});
}

Interval chosen(const Interval& a, const Interval& b, const Interval& c) {
  if (is_point(a)) return hull({select(a.low, b.low, c.low), select(a.low, b.high, c.high)});
  return hull({b.low, b.high, c.low, c.high});
}

}  // namespace

void run_tape(std::span<const Instruction> instructions, std::span<Interval> slots) {
  for (const Instruction& i : instructions) {
    const Interval a = slots[i.a], b = slots[i.b];
    Interval& value = slots[i.result];
    switch (i.code) {
      case Code::add:
        value = hull({a.low + b.low, a.high + b.high});
        break;
      case Code::subtract:
        value = hull({a.low - b.high, a.high - b.low});
        break;
      case Code::multiply:
        value = i.a == i.b ? square(a) : product(a, b);
        break;
      case Code::divide:
        value = quotient(a, b);
        break;
      case Code::power:
        value = power(a, b);
        break;
      case Code::negate:
        value = {-a.high, -a.low};
        break;
      case Code::sin:
        value = sine(a, 0);
        break;
      case Code::cos:
        value = sine(a, std::numbers::pi / 2);
        break;
      case Code::tan:
        value = tangent(a);
        break;
      case Code::asin:
        value = rising([](double x) { return std::asin(x); }, a, -1, 1);
        break;
      case Code::acos:
        value = rising([](double x) { return std::acos(x); }, a, -1, 1);
        break;
      case Code::atan:
        value = rising([](double x) { return std::atan(x); }, a);
        break;
      case Code::atan2:
        value = angle(a, b);
        break;
      case Code::exp:
        value = rising([](double x) { return std::exp(x); }, a);
        break;
      case Code::log:
        value = rising([](double x) { return std::log(x); }, a, 0);
        break;
      case Code::sqrt:
        value = rising([](double x) { return std::sqrt(x); }, a, 0);
        break;
      case Code::hypot: {
        const Interval x = magnitude(a), y = magnitude(b);
        value = {std::hypot(x.low, y.low), std::hypot(x.high, y.high)};
        break;
      }
      case Code::noise:
        value = sampled_noise(a, b, 0);
        break;
      case Code::noise_derivative:
        value = sampled_noise(a, b, 1);
        break;
      case Code::select:
        value = chosen(a, b, slots[i.c]);
        break;
      case Code::gate:
        value = product(a, b);
        break;
      case Code::less:
        value = truth(a.high < b.low, a.low >= b.high);
        break;
      case Code::less_equal:
        value = truth(a.high <= b.low, a.low > b.high);
        break;
      case Code::equal:
        value = truth(is_point(a) && is_point(b) && a.low == b.low, a.high < b.low || b.high < a.low);
        break;
      case Code::multiply_add: {
        const Interval p = product(a, b), c = slots[i.c];
        value = hull({p.low + c.low, p.high + c.high});
        break;
      }
      case Code::multiply_subtract: {
        const Interval p = product(a, b), c = slots[i.c];
        value = hull({c.low - p.high, c.high - p.low});
        break;
      }
      case Code::table_value:
      case Code::table_slope:
      case Code::table_end:
      case Code::table_begin:
      case Code::table_segment:
        value = table_range(i, slots);
        break;
    }
  }
}

}  // namespace oblique::network
