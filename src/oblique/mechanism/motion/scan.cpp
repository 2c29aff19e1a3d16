// SPDX-License-Identifier: MIT
#include <oblique/mechanism/motion/scan.h>

#include <algorithm>
#include <cmath>

namespace oblique::mechanism {
namespace {

/// Of a signal's scale per motion range: slower than this it stands.
constexpr double kStands = 1e-12;
/// Of a signal's scale: turning points that differ by less are rounding.
constexpr double kSameValue = 1e-10;
constexpr double kWidth = 1e-15;  ///< of u

/// −1, 0 or +1: where a signal goes.
int direction(const Signal& signal, const SignalValue& value, double duration) {
  if (!(std::abs(value.rate) * duration > kStands * signal.scale)) return 0;
  return value.rate > 0 ? 1 : -1;
}

/// The zero of the rate between two places at which it has different signs: false position with the Illinois
/// rule, then halving.
TurningPoint turning_point(RangeWalk& walk, const Signal& signal, double a, double b, double rate_a,
                           double rate_b) {
  constexpr int kSecants = 16, kMost = 80;
  TurningPoint found;
  found.is_greatest = rate_a > 0;
  int kept = 0;  // the end that the last step kept: −1 for a, +1 for b
  for (int i = 0; i < kMost && b - a > kWidth; ++i) {
    double u = a + (b - a) / 2;
    if (i < kSecants) u = std::clamp(a - rate_a * (b - a) / (rate_b - rate_a), a, b);
    walk.go(u);
    const SignalValue here = signal.at(walk);
    static_cast<Reading&>(found) = read(walk, here.value);
    if (here.rate == 0 || !std::isfinite(here.rate) || u == a || u == b) break;
    if ((here.rate > 0) == (rate_a > 0)) {
      a = u;
      rate_a = here.rate;
      if (kept == 1) rate_b /= 2;
      kept = 1;
    } else {
      b = u;
      rate_b = here.rate;
      if (kept == -1) rate_a /= 2;
      kept = -1;
    }
  }
  return found;
}

/// The least value (`sign` = +1) or the greatest (−1) within a bracket, by the golden section.
Reading golden(RangeWalk& walk, const Signal& signal, double a, double b, double sign) {
  constexpr double kGolden = 0.6180339887498949;
  constexpr double kEnough = 1e-9;
  const auto value = [&](double u) {
    walk.go(u);
    return sign * signal.at(walk).value;
  };
  double c = b - kGolden * (b - a), d = a + kGolden * (b - a);
  double at_c = value(c), at_d = value(d);
  while (b - a > kEnough) {
    if (at_c < at_d) {
      b = d;
      d = c;
      at_d = at_c;
      c = b - kGolden * (b - a);
      at_c = value(c);
    } else {
      a = c;
      c = d;
      at_c = at_d;
      d = a + kGolden * (b - a);
      at_d = value(d);
    }
  }
  const double least = value((a + b) / 2);
  return read(walk, sign * least);
}

/// Takes away turning points of rounding: neighbours with the same value.
void forget_rounding(std::vector<TurningPoint>& turns, double scale) {
  for (std::size_t i = 1; i < turns.size();) {
    if (std::abs(turns[i].value - turns[i - 1].value) > kSameValue * scale) {
      ++i;
      continue;
    }
    turns.erase(turns.begin() + static_cast<std::ptrdiff_t>(i) - 1,
                turns.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    i = std::max<std::size_t>(1, i - 1);
  }
}

/// The course of one signal from sample to sample.
struct Course {
  int first_direction = 0, last_direction = 0;
  double last_place = 0, last_rate = 0;
};

void take(Reading& least, Reading& greatest, const Reading& reading) {
  if (std::isnan(least.value) || reading.value < least.value) least = reading;
  if (std::isnan(greatest.value) || reading.value > greatest.value) greatest = reading;
}

}  // namespace

Reading read(const RangeWalk& walk, double value) {
  return {value, walk.place(), walk.time(), walk.drives().front().value};
}

std::vector<SignalScan> scan(RangeWalk& walk, const std::vector<Signal>& signals) {
  const std::size_t samples = walk.motion_range().samples;
  const double duration = walk.motion_range().duration();
  std::vector<SignalScan> scans(signals.size());
  std::vector<Course> courses(signals.size());
  for (std::size_t k = 0; k <= samples; ++k) {
    const double u = static_cast<double>(k) / static_cast<double>(samples);
    walk.go(u);
    std::vector<SignalValue> here;
    here.reserve(signals.size());
    for (const Signal& signal : signals) here.push_back(signal.at(walk));
    for (std::size_t s = 0; s < signals.size(); ++s) {
      const Reading reading = read(walk, here[s].value);
      SignalScan& scan = scans[s];
      scan.values.push_back(here[s].value);
      if (k == 0) scan.first = scan.least = scan.greatest = reading;
      take(scan.least, scan.greatest, reading);
      scan.last = reading;
    }
    for (std::size_t s = 0; s < signals.size(); ++s) {
      if (!signals[s].has_rate) continue;
      Course& course = courses[s];
      const int now = direction(signals[s], here[s], duration);
      if (now == 0) continue;
      if (course.last_direction == 0) course.first_direction = now;
      if (course.last_direction == -now) {
        scans[s].turns.push_back(
            turning_point(walk, signals[s], course.last_place, u, course.last_rate, here[s].rate));
        walk.go(u);
      }
      course = {course.first_direction, now, u, here[s].rate};
    }
  }
  for (std::size_t s = 0; s < signals.size(); ++s) {
    SignalScan& scan = scans[s];
    if (!signals[s].has_rate) {
      const double step = 1 / static_cast<double>(samples);
      for (const double sign : {1.0, -1.0}) {
        Reading& extreme = sign > 0 ? scan.least : scan.greatest;
        const double u = extreme.place;
        const Reading refined =
            golden(walk, signals[s], std::max(0.0, u - step), std::min(1.0, u + step), sign);
        if (sign * refined.value < sign * extreme.value) extreme = refined;
      }
      continue;
    }
    const Course& course = courses[s];
    if (walk.motion_range().closed && course.first_direction == -course.last_direction &&
        course.last_direction != 0) {
      TurningPoint at_end;
      static_cast<Reading&>(at_end) = scan.last;
      at_end.is_greatest = course.last_direction > 0;
      scan.turns.push_back(at_end);
    }
    forget_rounding(scan.turns, signals[s].scale);
    for (const TurningPoint& turn : scan.turns) take(scan.least, scan.greatest, turn);
  }
  return scans;
}

}  // namespace oblique::mechanism
