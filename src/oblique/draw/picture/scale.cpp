// SPDX-License-Identifier: MIT
#include <oblique/draw/picture/scale.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

#include <fmt/format.h>

namespace oblique::draw {
namespace {

/// Ranges are rounded to the ticks of about this many.
constexpr double kTicksOfRange = 5;
/// Errors that rounding leaves would stretch a logarithmic axis over dozens of empty decades.
constexpr double kMostDecades = 12;
/// What a division by the step may be off a whole number.
constexpr double kRounding = 1e-9;

/// "−0.5": with a minus sign as long as a plus.
std::string number_text(double value, int decimals) {
  const std::string text = fmt::format("{:.{}f}", std::abs(value), decimals);
  const bool zero = text.find_first_not_of("0.") == std::string::npos;
  return value < 0 && !zero ? "−" + text : text;
}

}  // namespace

std::string power_of_ten(int exponent) {
  constexpr std::array<std::string_view, 10> kDigits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "10⁻" : "10";
  for (const char digit : std::to_string(std::abs(exponent)))
    text += kDigits[static_cast<std::size_t>(digit - '0')];
  return text;
}

Scale::Scale(const Axis& axis, const std::vector<double>& values, bool round) : axis_(axis) {
  bool any = false;
  for (const double value : values) {
    if (!shows(value)) continue;
    low_ = any ? std::min(low_, value) : value;
    high_ = any ? std::max(high_, value) : value;
    any = true;
  }
  if (axis.logarithmic) {
    if (!any) low_ = 1, high_ = 10;
    const double top = std::ceil(std::log10(high_) - kRounding);
    const double bottom = std::max(std::floor(std::log10(low_) + kRounding), top - kMostDecades);
    low_ = std::pow(10, std::min(bottom, top - 1));
    high_ = std::pow(10, top);
    return;
  }
  if (!any) low_ = 0, high_ = 1;
  const double size = std::max(std::abs(low_), std::abs(high_));
  if (high_ - low_ <= kRounding * size) {  // a constant: room for its size, or for 1
    const double half = size > 0 ? size / 2 : 0.5;
    low_ -= half;
    high_ += half;
  }
  if (!round) return;
  step_ = step(kTicksOfRange);
  low_ = step_ * std::floor(low_ / step_ + kRounding);
  high_ = step_ * std::ceil(high_ / step_ - kRounding);
}

bool Scale::can_show(const Axis& axis, double value) {
  return std::isfinite(value) && (!axis.logarithmic || value > 0);
}

double Scale::position(double value) const {
  return axis_.logarithmic ? std::log10(std::max(value, low_)) : value;
}

double Scale::fraction(double value) const {
  const double low = position(low_);
  return (position(value) - low) / (position(high_) - low);
}

void Scale::pad(double part) {
  if (axis_.logarithmic) {
    const double factor = std::pow(high_ / low_, part);
    low_ /= factor;
    high_ *= factor;
  } else {
    widen((high_ - low_) * (1 + 2 * part));
  }
}

void Scale::widen(double length) {
  const double middle = (low_ + high_) / 2;
  low_ = middle - length / 2;
  high_ = middle + length / 2;
  step_ = 0;
}

double Scale::step(double most) const {
  const double least = (high_ - low_) / most;
  if (axis_.unit == "°") {  // parts of a turn are rounder than decimal numbers
    for (const double step : {1, 2, 5, 10, 15, 30, 45, 60, 90, 180, 360}) {
      if (step >= least * (1 - kRounding) && least > 0.5) return step;
    }
  }
  const double decade = std::pow(10, std::floor(std::log10(least) + kRounding));
  for (const double factor : {1, 2, 5}) {
    if (factor * decade >= least * (1 - kRounding)) return factor * decade;
  }
  return 10 * decade;
}

void Scale::count_like(const Scale& other) {
  size_of_other_ = std::max(size_of_other_, other.size());
}

double Scale::size() const {
  return std::max({std::abs(low_), std::abs(high_), size_of_other_});
}

int Scale::power() const {
  if (axis_.logarithmic) return 0;
  const int exponent = static_cast<int>(std::floor(std::log10(size()) + kRounding));
  const bool short_enough = exponent >= -2 && exponent <= 3;
  return short_enough ? 0 : 3 * static_cast<int>(std::floor(exponent / 3.0));
}

std::vector<Tick> Scale::ticks(double most) const {
  std::vector<Tick> ticks;
  if (axis_.logarithmic) {
    const int first = static_cast<int>(std::ceil(std::log10(low_) - kRounding));
    const int last = static_cast<int>(std::floor(std::log10(high_) + kRounding));
    const int each = std::max(1, static_cast<int>(std::ceil((last - first + 1) / most)));
    for (int exponent = first; exponent <= last; ++exponent) {
      const double decade = std::pow(10, exponent);
      ticks.push_back({decade, (exponent - first) % each == 0 ? power_of_ten(exponent) : std::string()});
      if (last - first > most) continue;
      for (int digit = 2; digit <= 9 && exponent < last; ++digit) ticks.push_back({digit * decade, {}});
    }
    return ticks;
  }
  const bool ends_show = step_ > 0 && (high_ - low_) / step_ <= most + 2;
  const double step = ends_show ? step_ : this->step(most), unit = std::pow(10, power());
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step / unit) + kRounding)));
  const auto first = static_cast<std::int64_t>(std::ceil(low_ / step - kRounding));
  const auto last = static_cast<std::int64_t>(std::floor(high_ / step + kRounding));
  for (std::int64_t k = first; k <= last; ++k) {
    const double value = static_cast<double>(k) * step;
    ticks.push_back({value, number_text(value / unit, decimals)});
  }
  return ticks;
}

std::string Scale::title() const {
  const int power = this->power();
  std::string unit = power == 0 ? std::string() : power_of_ten(power);
  if (!axis_.unit.empty()) unit += (unit.empty() ? "" : " ") + axis_.unit;
  if (unit.empty()) return axis_.name;
  return axis_.name.empty() ? fmt::format("[{}]", unit) : fmt::format("{} [{}]", axis_.name, unit);
}

}  // namespace oblique::draw
