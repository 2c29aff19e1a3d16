// SPDX-License-Identifier: MIT
#include <oblique/network/program/evaluation.h>

#include <functional>
#include <stdexcept>

#include <gtest/gtest.h>

#include "../support/compiled.h"

namespace oblique::network {
namespace {

using testing::Compiled;
using testing::message_of;

/// c = ±1 as x is above or below 0; q of an algebraic loop, q = x − q.
constexpr const char* kRelayAndLoop = R"(c = { type = "sign", in = "x" }
q = { type = "summer", in = ["x", "-q"] }
x = { type = "integrator", in = "c", initial = 3 }
)";

class Reading : public ::testing::Test {
 protected:
  Evaluation evaluate(double x) {
    std::vector<double> event_functions(made_.program.switches().size());
    return made_.program.event_functions(0, &x, event_functions.data(), workspace_).value();
  }

  const Compiled made_{kRelayAndLoop};
  Workspace workspace_{made_.program};
};

// What a sign compares is x and 0; on its lower side dx/dt is −1.
TEST_F(Reading, GivesWhatWasEvaluated) {
  const Evaluation here = evaluate(3);
  double derivative = 0, rate = 0;
  here.derivatives(&derivative);
  EXPECT_EQ(derivative, -1);
  EXPECT_EQ(here.event_function_rates(&derivative, &rate), 0);  // nothing periodic
  EXPECT_EQ(rate, -1);
  here.derivatives(&derivative);  // the rates have left it as it was
  EXPECT_EQ(derivative, -1);
}

TEST_F(Reading, IsRefusedWhereItIsStale) {
  const Program& program = made_.program;
  ASSERT_EQ(program.switches().size(), 1U);
  ASSERT_EQ(program.unknowns().size(), 1U);
  const std::uint32_t discrete_state = program.switches()[0].discrete_state;
  double x = 2, out[8] = {};
  std::vector<double> jacobian(program.jacobian_pattern().entries()), signals(program.n_signals());
  const std::vector<double> discrete_states(workspace_.discrete_states().begin(),
                                            workspace_.discrete_states().end());
  const std::vector<std::pair<const char*, std::function<void()>>> uses{
      {"derivatives", [&] { program.derivatives(0, &x, out, workspace_); }},
      {"jacobian", [&] { program.jacobian(0, &x, jacobian.data(), workspace_); }},
      {"surfaces", [&] { program.event_functions(0, &x, out, workspace_); }},
      {"signals", [&] { program.signals(0, &x, signals.data(), workspace_); }},
      {"decide_in_order",
       [&] { program.decide_in_order(0, &x, &x, workspace_, [](std::uint32_t, double, double) {}); }},
      {"set_discrete_state",
       [&] { workspace_.set_discrete_state(discrete_state, 1 - workspace_.discrete_state(discrete_state)); }},
      {"load_discrete_states", [&] { workspace_.load_discrete_states(discrete_states); }},
      {"set_unknown", [&] { workspace_.set_unknown(0, 7); }},
      {"hold_loop", [&] { workspace_.hold_loop(0, 0, {7}, true); }},
      {"reset", [&] { workspace_.reset(); }},
  };
  for (const auto& [name, use] : uses) {
    const Evaluation here = evaluate(3);
    use();
    for (const auto& read : std::initializer_list<std::function<void()>>{
             [&] { here.derivatives(out); }, [&] { here.compared_size(0); },
             [&] { here.event_function_rates(&x, out); }, [&] { here.pieces_meet(0); }}) {
      EXPECT_EQ(message_of<std::logic_error>(read),
                "an evaluation was read after its workspace had been used for another")
          << name;
    }
  }
}

TEST_F(Reading, StaysGoodWhereNothingChanges) {
  const Evaluation here = evaluate(3);
  const std::uint32_t discrete_state = made_.program.switches()[0].discrete_state;
  workspace_.set_discrete_state(discrete_state, workspace_.discrete_state(discrete_state));
  Workspace other(made_.program);
  double x = 2, derivative = 0;
  ASSERT_TRUE(made_.program.derivatives(0, &x, &derivative, other));
  EXPECT_NO_THROW(here.derivatives(&derivative));
}

// dg/dq of g = x − q − q is −2, and the solution x/2.
TEST_F(Reading, GivesTheJacobianOfALoopWithTheSignals) {
  const double x = 3;
  std::vector<double> signals(made_.program.n_signals());
  const auto here = made_.program.signals(0, &x, signals.data(), workspace_);
  ASSERT_TRUE(here);
  EXPECT_DOUBLE_EQ(here->loop_jacobian(0)(0, 0), -2);
  EXPECT_DOUBLE_EQ(signals[made_.signal("q")], 1.5);
  workspace_.set_unknown(0, 0);
  EXPECT_THROW(here->loop_jacobian(0), std::logic_error);
}

}  // namespace
}  // namespace oblique::network
