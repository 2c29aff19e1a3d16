// SPDX-License-Identifier: MIT
// The oscilloscope, shown signals in closed form piece by piece.
#include <oblique/console/probe.h>

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace oblique::console {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr double kTurn = 2 * std::numbers::pi;

/// sin t, and for the trigger again.
void sine(double t, std::vector<double>& values) {
  values = {std::sin(t), std::sin(t)};
}

/// Shows a probe pieces that end at multiples of `step`.
void show(Probe& probe, double until, double step, const Probe::Read& read) {
  double t = 0;
  for (int k = 1; t < until; ++k) {
    const double end = std::min(k * step, until);
    probe.look(t, end, true, read);
    t = end;
  }
}

ProbeSettings triggered(double level, Trigger::Slope slope, double length, double hold_off = 0) {
  ProbeSettings settings;
  settings.names = {"x"};
  settings.interval = 0.25;
  settings.trigger = Trigger{"x", level, slope, hold_off};
  settings.length = length;
  return settings;
}

std::vector<double> begins(const Probe& probe) {
  std::vector<double> all;
  for (const Trace& trace : probe.traces()) all.push_back(trace.begin);
  return all;
}

TEST(Probe, RecordsAtItsIntervalWhateverThePieces) {
  ProbeSettings settings;
  settings.names = {"x"};
  settings.interval = 0.1;
  std::vector<double> first;
  for (const double step : {0.013, 0.1, 0.77, 5.0}) {
    Probe probe(settings, 0);
    show(probe, 5, step, sine);
    ASSERT_THAT(probe.traces(), SizeIs(1));
    const Trace& trace = probe.traces().front();
    ASSERT_THAT(trace.times, SizeIs(51));
    for (std::size_t k = 0; k < trace.times.size(); ++k) {
      EXPECT_EQ(trace.times[k], 0.1 * static_cast<double>(k)) << "counted, not added up";
      EXPECT_EQ(trace.values[0][k], std::sin(trace.times[k]));
    }
  }
}

TEST(Probe, RecordsEveryStepAndBothSidesOfAJump) {
  ProbeSettings settings;
  settings.names = {"x"};
  Probe probe(settings, 0);
  const auto constant = [](double value) {
    return [value](double, std::vector<double>& values) { values = {value}; };
  };
  probe.look(0, 1, true, constant(3));
  probe.look(1, 1.5, false, constant(3));  // the way that was asked for ends within a step
  probe.look(1.5, 2, true, constant(3));
  probe.look(2, 3, true, constant(7));
  EXPECT_THAT(probe.traces().front().times, ElementsAre(0, 1, 2, 2, 3));
  EXPECT_THAT(probe.traces().front().values[0], ElementsAre(3, 3, 3, 7, 7));
}

// sin t rises through 1/2 at π/6 of each turn and falls through it at 5π/6.
TEST(Probe, IsTriggeredByLevelAndSlope) {
  const double up = kTurn / 12, down = 5 * kTurn / 12;
  using Slope = Trigger::Slope;
  for (const double step : {0.01, 0.4, 1.1}) {
    Probe rising(triggered(0.5, Slope::rising, 1), 0), falling(triggered(0.5, Slope::falling, 1), 0),
        either(triggered(0.5, Slope::either, 1), 0);
    for (Probe* probe : {&rising, &falling, &either}) show(*probe, 13, step, sine);
    const auto near = [](double t) { return ::testing::DoubleNear(t, 1e-14); };  // roundings of t = 10
    EXPECT_THAT(begins(rising), ElementsAre(near(up), near(kTurn + up))) << step;
    EXPECT_THAT(begins(falling), ElementsAre(near(down), near(kTurn + down)));
    EXPECT_THAT(begins(either), ElementsAre(near(up), near(down), near(kTurn + up), near(kTurn + down)));
    EXPECT_THAT(rising.traces()[0].times, SizeIs(5)) << "a row a quarter, in one second";
  }
}

TEST(Probe, HoldsOff) {
  Probe probe(triggered(0, Trigger::Slope::either, 0.5, 4), 0);
  show(probe, 20, 0.3, sine);
  // From 0 on it rises; 4 s later it is ready, and the next passage of zero is at 2π, and so on.
  const auto near = [](double t) { return ::testing::DoubleNear(t, 1e-14); };
  EXPECT_THAT(begins(probe), ElementsAre(near(0), near(kTurn), near(2 * kTurn), near(3 * kTurn)));
}

TEST(Probe, FiresASingleShot) {
  ProbeSettings settings = triggered(0.5, Trigger::Slope::rising, 1);
  settings.most_traces = 1;
  Probe probe(settings, 0);
  show(probe, 20, 0.3, sine);
  EXPECT_THAT(begins(probe), SizeIs(1));
  EXPECT_THAT(probe.traces()[0].times, SizeIs(5));
}

// What has ended is given once; the hold-off and the number of traces count what was taken off too.
TEST(Probe, GivesTracesThatHaveEnded) {
  ProbeSettings settings = triggered(0.5, Trigger::Slope::rising, 1, kTurn + 1);
  settings.most_traces = 3;
  Probe taken(settings, 0), kept(settings, 0);
  show(kept, 60, 0.3, sine);
  std::vector<double> begun;
  double t = 0;
  for (int k = 1; k <= 200; ++k) {
    const double end = k * 0.3;
    taken.look(t, end, true, sine);
    t = end;
    for (const Trace& trace : taken.take_ended()) {
      begun.push_back(trace.begin);
      EXPECT_THAT(trace.times, SizeIs(5)) << "a whole one";
    }
    ASSERT_LE(taken.traces().size(), 1U) << "the one that is recorded stays";
  }
  // the hold-off, just over a turn, passes over every other turn
  const auto near = [](double at) { return ::testing::DoubleNear(at, 1e-13); };  // as above, of t = 26
  EXPECT_THAT(begun, ElementsAre(near(kTurn / 12), near(25 * kTurn / 12), near(49 * kTurn / 12)));
  EXPECT_THAT(begins(kept), ElementsAre(near(begun[0]), near(begun[1]), near(begun[2])));
  EXPECT_THAT(taken.take_ended(), IsEmpty());
}

// The time may go back: a hold-off of before does not count.
TEST(Probe, IsReadyAtOnceWhereTheMachineStandsElsewhere) {
  Probe probe(triggered(0.5, Trigger::Slope::rising, 1, 100), 0);
  show(probe, 4, 0.3, sine);
  EXPECT_THAT(begins(probe), SizeIs(1));
  probe.jump(0);
  show(probe, 4, 0.3, sine);
  ASSERT_THAT(begins(probe), SizeIs(2));
  EXPECT_EQ(begins(probe)[0], begins(probe)[1]);
}

TEST(Probe, IsTriggeredByAJump) {
  Probe probe(triggered(0.5, Trigger::Slope::rising, 1), 0);
  const auto step_at_2 = [&](double low) {
    return [low](double, std::vector<double>& values) { values = {low, low}; };
  };
  probe.look(0, 2, true, step_at_2(0));
  EXPECT_THAT(probe.traces(), IsEmpty());
  probe.look(2, 3, true, step_at_2(1));
  EXPECT_THAT(begins(probe), ElementsAre(2));
}

TEST(Probe, BeginsAnewWhereTheMachineStandsElsewhere) {
  ProbeSettings settings;
  settings.names = {"x"};
  settings.interval = 1;
  Probe probe(settings, 0);
  probe.look(0, 2.5, true, sine);
  probe.jump(1);
  probe.look(1, 2.5, true, sine);
  ASSERT_THAT(probe.traces(), SizeIs(2));
  EXPECT_THAT(probe.traces()[0].times, ElementsAre(0, 1, 2));
  EXPECT_THAT(probe.traces()[1].times, ElementsAre(1, 2));
}

}  // namespace
}  // namespace oblique::console
