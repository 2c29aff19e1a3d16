// SPDX-License-Identifier: MIT
#include <oblique/solve/events/event_pace.h>

#include <cmath>

namespace oblique::solve {
namespace {

constexpr int kMostShorter = 10;
constexpr double kZenoTime = 1e-5;  ///< of the run
/// Three intervals are enough where they shorten this quickly, and their two ratios are the same to such a
/// part of them: they are soon within the errors of the states, where no event can be told.
constexpr double kQuickly = 0.7;
constexpr double kSameRatio = 0.01;
constexpr double kSteadyOver = 4;
constexpr double kSteady = 0.75;
constexpr double kAlone = 0.1;  ///< of the ratio before: one that comes so soon is not of the row

}  // namespace

std::optional<EventPace::Zeno> EventPace::come(double t, double span, double end) {
  const double now = t - last;
  shorter = now > 0 && interval && now < *interval ? shorter + 1 : 0;
  const double present = interval ? now / *interval : 1;
  // One that comes soon for once (a pulse beside the rhythm) says nothing of the next ones.
  const double next = shorter > 1 ? std::max(present, ratio) : present;
  const double left = now * next / (1 - next);  // Σ now · nextᵏ
  constexpr double kTiny = 1e-6;                // of the run
  if (now < kTiny * span && shorter < kMostShorter) ++tiny;
  if (!(now < kZenoTime * span)) tiny = 0;
  if (shorter == 0) {
    steady = false;
    longer.reset();
  } else if (!longer || kSteadyOver * now < *longer) {
    steady = longer && 1 - present > kSteady * approach;
    longer = now;
    approach = 1 - present;
  }
  const bool quick = shorter > 1 && present < kQuickly && std::abs(present - ratio) < kSameRatio * present;
  const bool many = steady && shorter >= kMostShorter && now < kZenoTime * span;
  constexpr double kSoon = 1e-2;  // of the run
  const bool comes_faster =
      steady && shorter >= kMostShorter && left < kSoon * span && present > kAlone * ratio;
  if (comes_faster) {
    due = t + left;
  } else if (due && t > *due) {
    due.reset();  // it goes on coming
  }
  ratio = present;
  if ((many || quick) && left < kZenoTime * span && t + left < end) return Zeno{now, t + left};
  last = t;
  interval = now > 0 ? std::optional(now) : std::nullopt;
  return std::nullopt;
}

}  // namespace oblique::solve
