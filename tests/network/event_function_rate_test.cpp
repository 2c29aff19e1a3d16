// SPDX-License-Identifier: MIT
// What the search for events knows beforehand: rates of event functions, the structure of switches.
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "../support/compiled.h"

namespace oblique::network {
namespace {

using testing::Compiled;

/// The event function of switch 0 at (t, x).
double event_function_at(const Program& program, double t, const std::vector<double>& x) {
  Workspace workspace(program);
  std::vector<double> event_functions(program.switches().size());
  EXPECT_TRUE(program.event_functions(t, x.data(), event_functions.data(), workspace));
  return event_functions[0];
}

/// Its rate there, where the states move with their derivatives.
double rate_at(const Program& program, double t, const std::vector<double>& x) {
  Workspace workspace(program);
  std::vector<double> event_functions(program.switches().size()), rates(event_functions.size()),
      derivatives(x.size());
  const auto here = program.event_functions(t, x.data(), event_functions.data(), workspace);
  here.value().derivatives(derivatives.data());
  here->event_function_rates(derivatives.data(), rates.data());
  return rates[0];
}

/// The rate by a central difference along the solution, with nothing of the compiled derivative in it.
double differenced_rate(const Program& program, double t, const std::vector<double>& x) {
  Workspace workspace(program);
  std::vector<double> derivatives(x.size());
  EXPECT_TRUE(program.derivatives(t, x.data(), derivatives.data(), workspace));
  constexpr double kStep = 1e-5;
  std::vector<double> ahead = x, behind = x;
  for (std::size_t i = 0; i < x.size(); ++i) {
    ahead[i] += kStep * derivatives[i];
    behind[i] -= kStep * derivatives[i];
  }
  return (event_function_at(program, t + kStep, ahead) - event_function_at(program, t - kStep, behind)) /
         (2 * kStep);
}

void expect_rate(const Compiled& made, double t, const std::vector<double>& x) {
  const double exact = differenced_rate(made.program, t, x);
  EXPECT_NEAR(rate_at(made.program, t, x), exact,
              1e-8 * (1 + std::abs(exact)));  // the step squared, and rounding
}

TEST(EventFunctionRate, FollowsStatesAndTheTime) {
  expect_rate(Compiled(R"(x = { type = "integrator", in = ["-0.3*y", "0.1*x"], initial = 1 }
y = { type = "integrator", in = ["x"] }
xy = { type = "multiplier", in = ["x", "y"] }
w = { type = "sine-source", frequency = 0.7, phase = 0.2 }
c = { type = "comparator", in = ["xy", "-w"] }
)"),
              0.4, {0.8, -0.6});
}

TEST(EventFunctionRate, PassesThroughAlgebraicLoopsThatFollowEachOther) {
  // q = w/x by one loop, and r = √(1 + q²) by the next; the time enters the first.
  expect_rate(Compiled(R"(x = { type = "integrator", in = ["-0.5*r"], initial = 1 }
one = { type = "constant" }
w = { type = "sine-source", frequency = 0.3 }
xq = { type = "multiplier", in = ["x", "q"] }
q = { type = "servo-amplifier", in = ["xq", "-w"], gain = inf, bandwidth = inf }
qq = { type = "squarer", in = "q" }
rr = { type = "squarer", in = "r" }
r = { type = "servo-amplifier", in = ["rr", "-qq", "-one"], initial = 1, gain = inf, bandwidth = inf }
c = { type = "comparator", in = ["r", "-1.2*one"] }
)"),
              0.4, {0.8});
}

// q = w/x by a loop, and what is compared a function of it alone.
TEST(EventFunctionRate, PassesThroughFunctionsOfALoopsUnknown) {
  for (const char* const function : {"sine", "exponential", "arc-tangent", "squarer", "inverter"}) {
    SCOPED_TRACE(function);
    expect_rate(Compiled(R"(x = { type = "integrator", in = ["-0.5*q"], initial = 1 }
one = { type = "constant" }
w = { type = "sine-source", frequency = 0.3 }
xq = { type = "multiplier", in = ["x", "q"] }
q = { type = "servo-amplifier", in = ["xq", "-w"], gain = inf, bandwidth = inf }
f = { type = ")" + std::string(function) +
                         R"(", in = "q" }
c = { type = "comparator", in = ["f", "-0.2*one"] }
)"),
                0.4, {0.8});
  }
}

/// The switch of a block.
std::size_t switch_of(const Program& program, std::string_view block) {
  for (std::size_t s = 0; s < program.switches().size(); ++s) {
    if (program.switches()[s].block == block) return s;
  }
  throw std::out_of_range(std::string(block));
}

TEST(SwitchStructure, PutsOneSwitchingSurfaceIntoOneUnit) {
  const Compiled made(R"(x = { type = "integrator", in = ["-s", "-a"], initial = 1 }
s = { type = "sign", in = "x" }
a = { type = "absolute-value", in = "x" }
y = { type = "sign", in = "n" }
n = { type = "inverter", in = "x" }
)");
  const SwitchStructure& structure = made.program.switch_structure();
  ASSERT_EQ(made.program.switches().size(), 3U);
  EXPECT_EQ(structure.members.size(), 1U);
  int opposite = 0;
  for (const bool other_side : structure.opposite) opposite += other_side ? 1 : 0;
  EXPECT_EQ(opposite, 1);
}

TEST(SwitchStructure, CouplesWhatIsNoSum) {
  const auto coupled = [](const char* blocks) {
    const Compiled made(blocks);
    return made.program.switch_structure().is_coupled(0, 1);
  };
  EXPECT_FALSE(coupled(R"(x = { type = "integrator", in = ["-s", "2*r"], initial = 1 }
y = { type = "integrator", in = ["-r"] }
s = { type = "sign", in = "x" }
r = { type = "sign", in = "y" }
)"));
  EXPECT_TRUE(coupled(R"(x = { type = "integrator", in = ["-p"], initial = 1 }
y = { type = "integrator", in = ["-r"] }
s = { type = "sign", in = "x" }
r = { type = "sign", in = "y" }
p = { type = "multiplier", in = ["s", "r"] }
)"));
}

// s and r act on each other's quotient, which is no sum in either; u acts by itself.
TEST(SwitchStructure, CouplesBothWaysAndNobodyElse) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and("reciprocal", R"toml(
[inputs]
in = { sum = true }
[outputs]
out = {}
[equations]
out = "1/(3 + in)"
)toml");
  const Compiled made(R"(x = { type = "integrator", in = ["-p", "-u"], initial = 1 }
y = { type = "integrator", in = ["-r"] }
z = { type = "integrator", in = ["-u"] }
s = { type = "sign", in = "x" }
r = { type = "sign", in = "y" }
u = { type = "sign", in = "z" }
p = { type = "reciprocal", in = ["s", "r"] }
)",
                      "", library);
  const SwitchStructure& structure = made.program.switch_structure();
  const auto coupled = [&](std::string_view one, std::string_view other) {
    return structure.is_coupled(structure.unit[switch_of(made.program, one)],
                                structure.unit[switch_of(made.program, other)]);
  };
  EXPECT_TRUE(coupled("s", "r"));
  EXPECT_TRUE(coupled("r", "s"));
  for (const char* const other : {"s", "r"}) {
    EXPECT_FALSE(coupled("u", other));
    EXPECT_FALSE(coupled(other, "u"));
  }
}

/// Whether the units of the switches of blocks s and r are coupled.
bool couples_s_and_r(const Program& program) {
  const SwitchStructure& structure = program.switch_structure();
  return structure.is_coupled(structure.unit[switch_of(program, "s")],
                              structure.unit[switch_of(program, "r")]);
}

// The sum of two positions times a state, and a third of it, are linear in both.
TEST(SwitchStructure, DoesNotCoupleWhatIsLinear) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and("third", R"toml(
[inputs]
in = { sum = true }
[outputs]
out = {}
[equations]
out = "in/3"
)toml");
  EXPECT_FALSE(couples_s_and_r(Compiled(R"(x = { type = "integrator", in = ["-p"], initial = 1 }
y = { type = "integrator", in = ["-q"], initial = 1 }
s = { type = "sign", in = "x" }
r = { type = "sign", in = "y" }
sum = { type = "summer", in = ["s", "r"] }
p = { type = "multiplier", in = ["sum", "y"] }
q = { type = "third", in = ["s", "r"] }
)",
                                        "", library)
                                   .program));
}

// m = −(0.5 m − s): what the loop brings of s is multiplied by r; and so is what another loop brings of that
// one.
TEST(SwitchStructure, CouplesThroughLoops) {
  for (const char* const last : {"m", "n"}) {
    EXPECT_TRUE(couples_s_and_r(Compiled(R"(x = { type = "integrator", in = ["-p"], initial = 1 }
y = { type = "integrator", in = ["-r"] }
s = { type = "sign", in = "x" }
r = { type = "sign", in = "y" }
m = { type = "summer", in = ["-s", "0.5*m"] }
n = { type = "summer", in = ["-m", "0.25*n"] }
p = { type = "multiplier", in = ["r", ")" +
                                         std::string(last) + "\"] }\n")
                                    .program))
        << last;
  }
}

// s → p → q by positions alone; s itself and r follow states.
TEST(SwitchStructure, KnowsWhatFollowsAPosition) {
  const Compiled made(R"(x = { type = "integrator", in = ["-s"], initial = 1 }
z = { type = "integrator", in = ["-r", "q"] }
s = { type = "sign", in = "x" }
sx = { type = "summer", in = ["s", "0.5*x"] }
p = { type = "sign", in = "sx" }
pz = { type = "summer", in = ["p", "0.2*s", "z"] }
q = { type = "sign", in = "pz" }
r = { type = "sign", in = "z" }
)");
  const Program& program = made.program;
  const SwitchStructure& structure = program.switch_structure();
  const std::size_t s = switch_of(program, "s"), p = switch_of(program, "p"), q = switch_of(program, "q"),
                    r = switch_of(program, "r");
  const auto followers_of = [&](std::size_t one) {
    std::vector<bool> these(program.switches().size(), false);
    these[one] = true;
    return structure.followers_of(these);
  };
  std::vector<bool> expected(program.switches().size(), false);
  EXPECT_EQ(followers_of(q), expected);
  EXPECT_EQ(followers_of(r), expected);
  expected[q] = true;
  EXPECT_EQ(followers_of(p), expected);
  expected[p] = true;
  EXPECT_EQ(followers_of(s), expected);
  const auto s_number = static_cast<std::uint32_t>(s), p_number = static_cast<std::uint32_t>(p);
  EXPECT_EQ(structure.positions_below(q),
            (std::vector<std::uint32_t>{std::min(s_number, p_number), std::max(s_number, p_number)}));
  EXPECT_EQ(structure.positions_below(p), std::vector<std::uint32_t>{s_number});
  EXPECT_TRUE(structure.positions_below(s).empty());
}

TEST(SwitchStructure, SeesWhatAPositionDependsOnThroughALoop) {
  const Compiled made(R"(m = { type = "summer", in = ["-x", "0.5*c"] }
c = { type = "sign", in = "m" }
x = { type = "integrator", in = "c" }
k = { type = "sign", in = "x" }
)");
  const SwitchStructure& structure = made.program.switch_structure();
  const std::size_t c = switch_of(made.program, "c"), k = switch_of(made.program, "k");
  EXPECT_TRUE(structure.depends(c, c));
  EXPECT_FALSE(structure.depends(k, c));
  EXPECT_FALSE(structure.depends(k, k));
}

// Sums of so many terms and one more have one switching surface where the last term is the same, as far as
// they are looked through, and never where it is another.
TEST(SwitchStructure, TellsLongSumsApart) {
  const auto comparator = [](const std::string& name, int terms, const std::string& last) {
    std::string in;
    for (int k = 1; k <= terms; ++k) in += fmt::format("\"0.{:02}*x\", ", k);
    return name + " = { type = \"comparator\", in = [" + in + "\"" + last + "\"] }\n";
  };
  const std::string states =
      "x = { type = \"integrator\", in = \"y\", initial = 1 }\n"
      "y = { type = \"integrator\", in = \"z\" }\n"
      "z = { type = \"integrator\", in = \"-x\" }\n";
  for (const int terms : {3, 30, 60}) {
    const Compiled other(states + comparator("a", terms, "y") + comparator("b", terms, "z"));
    const SwitchStructure& apart = other.program.switch_structure();
    ASSERT_EQ(apart.unit.size(), 2U);
    EXPECT_NE(apart.unit[0], apart.unit[1]) << terms;
  }
  // terms that are not put together, with the other one first or last
  std::string many, sum;
  for (int k = 0; k < 50; ++k) {
    many += fmt::format("x{} = {{ type = \"integrator\", in = \"-x{}\" }}\n", k, k);
    sum += fmt::format("\"x{}\", ", k);
  }
  for (const bool last : {false, true}) {
    const auto with = [&](const char* name, const char* other) {
      return fmt::format("{} = {{ type = \"comparator\", in = [{}] }}\n", name,
                         last ? sum + other : other + (", " + sum));
    };
    const Compiled other(many + states + with("a", "\"y\"") + with("b", "\"z\""));
    const SwitchStructure& apart = other.program.switch_structure();
    ASSERT_EQ(apart.unit.size(), 2U);
    EXPECT_NE(apart.unit[0], apart.unit[1]) << last;
  }
  const Compiled same(states + comparator("a", 3, "y") + comparator("b", 3, "y"));
  EXPECT_EQ(same.program.switch_structure().unit[0], same.program.switch_structure().unit[1]);
}

}  // namespace
}  // namespace oblique::network
