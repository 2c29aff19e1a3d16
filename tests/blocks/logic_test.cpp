// SPDX-License-Identifier: MIT
// monostable, flip-flop, jk-flip-flop, counter, preset-counter, multiplexer, demultiplexer,
// digital-potentiometer. Times are those of known edges, so the levels are exact; rows do not fall on edges.
#include <algorithm>
#include <cmath>
#include <string>

#include "closed_form.h"

namespace oblique::test {
namespace {

using testing::Compiled;
using testing::expect_form;
using testing::kRounding;
using testing::last;
using testing::run_of;

double phase_of(double t, double period) {
  return t - period * std::floor(t / period);
}

TEST(Monostable, GivesAPulseOfItsLength) {
  const Compiled made(R"(p = { type = "pulse-train", delay = 0.2, width = 0.1 }
m = { type = "monostable", trigger = "p", length = 0.35, low = -0.5, high = 2 })");
  expect_form(run_of(made, {.until = 5, .samples = 504}), "m", 0, [](double t) {
    const double phase = phase_of(t, 1);
    return phase > 0.2 && phase < 0.55 ? 2 : -0.5;
  });
}

TEST(Monostable, IgnoresEdgesDuringThePulse) {
  // Edges at 0.1 + 0.2 n, each second of them during the pulse of 0.3.
  const Compiled made(R"(p = { type = "pulse-train", period = 0.2, width = 0.1, delay = 0.1 }
m = { type = "monostable", trigger = "p", length = 0.3 })");
  expect_form(run_of(made, {.until = 5, .samples = 504}), "m", 0, [](double t) {
    const double phase = phase_of(t, 0.4);
    return phase > 0.1 ? 1 : 0;
  });
}

TEST(Monostable, IsProlongedWhereItIsRetriggerable) {
  // Five edges 0.2 apart from 0.1 on, the last at 0.9.
  const Compiled made(R"(p = { type = "pulse-train", period = 0.2, width = 0.1, delay = 0.1 }
gate = { type = "step", at = 1, from = 1, to = 0 }
e = { type = "multiplier", in = ["p", "gate"] }
m = { type = "monostable", trigger = "e", length = 0.3, retriggerable = 1 })");
  expect_form(run_of(made, {.until = 3, .samples = 302}), "m", 0,
              [](double t) { return t > 0.1 && t < 1.2 ? 1 : 0; });
}

TEST(FlipFlop, IsSetAndReset) {
  const Compiled made(R"(s = { type = "pulse-train", delay = 0.1, width = 0.1 }
r = { type = "pulse-train", delay = 0.6, width = 0.1 }
f = { type = "flip-flop", set = "s", reset = "r", initial = 1 })");
  const auto result = run_of(made, {.until = 3, .samples = 304});
  const auto form = [](double t) {
    const double phase = phase_of(t, 1);
    return t < 0.1 || (phase > 0.1 && phase < 0.6) ? 1 : 0;
  };
  expect_form(result, "f.out", 0, form);
  expect_form(result, "f.inverse", 0, [&](double t) { return 1 - form(t); });
}

TEST(FlipFlop, IsResetWhereBothInputsAreHigh) {
  const Compiled made(R"(s = { type = "pulse-train", delay = 0.1, width = 0.4 }
r = { type = "pulse-train", delay = 0.2, width = 0.1 }
f = { type = "flip-flop", set = "s", reset = "r" })");
  expect_form(run_of(made, {.until = 1, .samples = 102}), "f.out", 0,
              [](double t) { return (t > 0.1 && t < 0.2) || t > 0.3 ? 1 : 0; });
}

TEST(JkFlipFlop, FollowsItsTable) {
  // j and k change between the edges at 0.5, 1.5, …: (0, 0), (1, 0), (0, 1), (1, 1), (1, 1).
  const Compiled made(R"(clock = { type = "pulse-train", delay = 0.5, width = 0.25 }
j1 = { type = "pulse-train", period = 100, delay = 1, width = 1 }
j2 = { type = "step", at = 3 }
j = { type = "summer", in = ["j1", "j2"] }
k = { type = "step", at = 2 }
f = { type = "jk-flip-flop", clock = "clock", j = "j", k = "k" })");
  const auto result = run_of(made, {.until = 5, .samples = 52});
  expect_form(result, "f.out", 0,
              [](double t) { return (t > 1.5 && t < 2.5) || (t > 3.5 && t < 4.5) ? 1 : 0; });
  expect_form(result, "f.inverse", 0,
              [](double t) { return (t > 1.5 && t < 2.5) || (t > 3.5 && t < 4.5) ? 0 : 1; });
}

TEST(JkFlipFlop, CountsSynchronouslyInARow) {
  // The second toggles where the first is 1 before the edge: both have the same clock.
  const Compiled made(R"(clock = { type = "pulse-train", delay = 1 }
a = { type = "jk-flip-flop", clock = "clock" }
b = { type = "jk-flip-flop", clock = "clock", j = "a.out", k = "a.out" }
n = { type = "summer", in = ["a.out", "2*b.out"] })");
  expect_form(run_of(made, {.until = 19.9, .samples = 202}), "n", 0,
              [](double t) { return std::fmod(std::floor(t), 4); });
}

TEST(JkFlipFlop, IsHeldByItsReset) {
  const Compiled made(R"(clock = { type = "pulse-train", delay = 0.5 }
r = { type = "pulse-train", period = 100, delay = 0.75, width = 1 }
f = { type = "jk-flip-flop", clock = "clock", reset = "r" })");
  expect_form(run_of(made, {.until = 3, .samples = 32}), "f.out", 0,
              [](double t) { return (t > 0.5 && t < 0.75) || t > 2.5 ? 1 : 0; });
}

TEST(Counter, CountsInDecades) {
  const Compiled made(R"(clock = { type = "pulse-train", period = 0.1, width = 0.05, delay = 0.1 }
units = { type = "counter", clock = "clock", modulus = 10, step = 0.1 }
tens  = { type = "counter", clock = "units.carry" })");
  const auto result = run_of(made, {.until = 9.97, .samples = 334});
  const auto count = [](double t) { return std::floor(t / 0.1 + 1e-9); };
  expect_form(result, "units.out", kRounding, [&](double t) { return 0.1 * std::fmod(count(t), 10); });
  expect_form(result, "tens.out", 0, [&](double t) { return std::floor(count(t) / 10); });
}

TEST(Counter, IsHeldAtZeroByItsReset) {
  const Compiled made(R"(clock = { type = "pulse-train", delay = 0.5 }
r = { type = "pulse-train", period = 100, delay = 2.75, width = 1 }
c = { type = "counter", clock = "clock", reset = "r" })");
  expect_form(run_of(made, {.until = 7, .samples = 72}), "c.out", 0, [](double t) {
    const double all = std::floor(t + 0.5);
    return t < 2.75 ? all : t < 3.75 ? 0 : all - 4;
  });
}

TEST(PresetCounter, CountsDownToZeroAndStaysThere) {
  const Compiled made(R"(clock = { type = "pulse-train", delay = 0.5 }
on = { type = "step", at = 1.2 }
c = { type = "preset-counter", clock = "clock", preset = 4, step = 0.25, enable = "on" })");
  const auto result = run_of(made, {.until = 8, .samples = 83});  // edges at 1.5, 2.5, … count
  const auto left = [](double t) { return std::max(0.0, 4 - std::max(0.0, std::floor(t - 0.5))); };
  expect_form(result, "c.out", 0, [&](double t) { return 0.25 * left(t); });
  expect_form(result, "c.zero", 0, [&](double t) { return left(t) == 0 ? 1 : 0; });
}

TEST(PresetCounter, DividesItsClockWhereItReloads) {
  const Compiled made(R"(clock = { type = "pulse-train", delay = 0.5 }
c = { type = "preset-counter", clock = "clock", preset = 2, reload = 1 }
n = { type = "counter", clock = "c.zero" })");
  expect_form(run_of(made, {.until = 10, .samples = 103}), "n.out", 0,
              [](double t) { return std::floor((t + 1.5) / 3); });  // zero from 1.5, 4.5, 7.5 on
}

TEST(PresetCounter, IsLoaded) {
  const Compiled made(R"(clock = { type = "pulse-train", delay = 0.5 }
load = { type = "pulse-train", period = 100, delay = 2.75, width = 1 }
c = { type = "preset-counter", clock = "clock", preset = 5, load = "load" })");
  expect_form(run_of(made, {.until = 7, .samples = 72}), "c.out", 0, [](double t) {
    if (t < 2.75) return 5 - std::floor(t + 0.5);
    return t < 3.75 ? 5 : 5 - std::floor(t + 0.5 - 4);
  });
}

/// Eight constants 0.1, 0.2, … on a multiplexer, whose address rises by 0.5 a second from −0.6 on.
TEST(Multiplexer, PassesTheInputThatIsAddressed) {
  std::string blocks = "a = { type = \"ramp\", initial = -0.6, slope = 0.5 }\n", inputs;
  for (int k = 0; k < 8; ++k) {
    blocks +=
        "c" + std::to_string(k) + " = { type = \"constant\", value = 0." + std::to_string(k + 1) + " }\n";
    inputs += "in" + std::to_string(k) + " = \"c" + std::to_string(k) + "\", ";
  }
  const Compiled made(blocks + "m = { " + inputs + "type = \"multiplexer\", address = \"a\", step = 0.5 }\n");
  expect_form(run_of(made, {.until = 10, .samples = 98}), "m", kRounding,
              [](double t) { return 0.1 * (1 + std::clamp(std::round((-0.6 + 0.5 * t) / 0.5), 0.0, 7.0)); });
}

TEST(Demultiplexer, PassesItsInputToTheOutputThatIsAddressed) {
  const Compiled made(R"(a = { type = "ramp", initial = -0.9 }
u = { type = "constant", value = 0.3 }
d = { type = "demultiplexer", in = "u", address = "a" }
one = { type = "demultiplexer", address = "a" })");
  const auto result = run_of(made, {.until = 10, .samples = 98});
  for (int k = 0; k < 8; ++k) {
    const auto chosen = [&](double t) { return std::clamp(std::round(t - 0.9), 0.0, 7.0) == k; };
    expect_form(result, "d.out" + std::to_string(k), 0, [&](double t) { return chosen(t) ? 0.3 : 0; });
    expect_form(result, "one.out" + std::to_string(k), 0, [&](double t) { return chosen(t) ? 1 : 0; });
  }
}

TEST(DigitalPotentiometer, IsSteppedWithinItsRangeAndQuantised) {
  // Steps of 0.3, up four times and then down; two bits have the settings 0, 1/3, 2/3, 1.
  const Compiled made(R"(in = { type = "constant", value = -2 }
clock = { type = "pulse-train", delay = 0.5, width = 0.25 }
first = { type = "step", at = 4, from = 1, to = 0 }
then = { type = "step", at = 4 }
up = { type = "multiplier", in = ["clock", "first"] }
down = { type = "multiplier", in = ["clock", "then"] }
d = { type = "digital-potentiometer", in = "in", up = "up", down = "down", step = 0.3, bits = 2 })");
  const auto result = run_of(made, {.until = 7, .samples = 72});
  const auto setting = [](double t) {  // asked: 0 0.3 0.6 0.9 1 0.7 0.4 0.1
    constexpr double kSettings[] = {0, 1 / 3.0, 2 / 3.0, 1, 1, 2 / 3.0, 1 / 3.0, 0};
    return kSettings[static_cast<std::size_t>(std::floor(t + 0.5))];
  };
  expect_form(result, "d.setting", kRounding, setting);
  expect_form(result, "d.out", kRounding, [&](double t) { return -2 * setting(t); });
}

TEST(DigitalPotentiometer, HasItsNumberOfBits) {
  const Compiled made(R"(in = { type = "constant" }
d = { type = "digital-potentiometer", in = "in", initial = 0.70710678, bits = 11 })");
  EXPECT_NEAR(last(run_of(made, {.samples = 2}), "d.out"), 1447.0 / 2047, kRounding);  // 1447.4
}

}  // namespace
}  // namespace oblique::test
