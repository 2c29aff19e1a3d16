// SPDX-License-Identifier: MIT
// Rodas5P as a solver, on equations with closed forms; its runs of whole diagrams are in rodas_test.cpp.
#include <oblique/solve/integrator/rosenbrock_solver.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace oblique::solve {
namespace {

/// A system with a full Jacobian; nothing where `rates` says so.
struct Equations final : OdeSystem {
  using Rates = std::function<bool(double t, const double* x, double* dxdt)>;
  using Jacobian = std::function<void(double t, const double* x, double* by_columns)>;
  Equations(std::size_t n, Rates rates_of, Jacobian jacobian_of)
      : rates(std::move(rates_of)), by_states(std::move(jacobian_of)) {
    for (std::size_t column = 0; column < n; ++column) {
      for (std::size_t row = 0; row < n; ++row) full.rows.push_back(static_cast<std::int64_t>(row));
      full.column_starts.push_back(static_cast<std::int64_t>(full.rows.size()));
    }
  }
  std::size_t size() const override { return full.size(); }
  const network::SparsePattern& pattern() const override { return full; }
  bool derivatives(double t, const double* x, double* dxdt) override { return rates(t, x, dxdt); }
  bool jacobian(double t, const double* x, double* values) override {
    by_states(t, x, values);
    return true;
  }
  bool is_jacobian_exact() const override { return exact; }
  bool is_to_end() const override { return ends; }

  network::SparsePattern full;
  Rates rates;
  Jacobian by_states;
  bool exact = true, ends = false;
};

SolverSettings at_tolerance(double tolerance) {
  SolverSettings settings;
  settings.relative_tolerance = tolerance;
  settings.absolute_tolerance = tolerance;
  settings.method = diagram::IntegrationMethod::rodas;
  return settings;
}

/// The largest error of a run to `end` against x(t) = truth(t) of the first state: at the ends of steps, and
/// between them.
struct Errors {
  double at_ends = 0, between = 0;
  long steps = 0;
};
Errors errors_of(OdeSystem& system, std::vector<double> start, double end, const SolverSettings& settings,
                 const std::function<double(double)>& truth) {
  RosenbrockSolver solver(system, 0, start, end, end, settings);
  Errors errors;
  std::vector<double> x(start.size());
  for (double t = 0; t < end;) {
    const double from = t;
    t = solver.step();
    errors.at_ends = std::max(errors.at_ends, std::abs(solver.states()[0] - truth(t)));
    for (int k = 1; k < 20; ++k) {
      const double at = from + (t - from) * k / 20;
      solver.states_at(at, x);
      errors.between = std::max(errors.between, std::abs(x[0] - truth(at)));
    }
  }
  errors.steps = solver.statistics().steps;
  return errors;
}

/// x′ = −2 t x², x = 1/(1 + t²).
Equations bell() {
  return {1,
          [](double t, const double* x, double* dxdt) {
            dxdt[0] = -2 * t * x[0] * x[0];
            return true;
          },
          [](double t, const double* x, double* j) { j[0] = -4 * t * x[0]; }};
}

/// x′ = −λ (x − cos t) − sin t, x = cos t (Prothero and Robinson).
Equations prothero_robinson(double rate) {
  return {1,
          [rate](double t, const double* x, double* dxdt) {
            dxdt[0] = -rate * (x[0] - std::cos(t)) - std::sin(t);
            return true;
          },
          [rate](double, const double*, double* j) { j[0] = -rate; }};
}

/// Steps of a length, whatever their errors.
SolverSettings steps_of(double length) {
  SolverSettings settings = at_tolerance(1e6);
  settings.max_step = length;
  return settings;
}

// Half the step leaves 1/32 of the error, and 1/16 or less between the ends.
TEST(RosenbrockSolver, IsOfOrderFive) {
  Equations system = bell();
  const auto truth = [](double t) { return 1 / (1 + t * t); };
  double last_order = 0;
  for (const double h : {0.1, 0.05, 0.025}) {
    const Errors coarse = errors_of(system, {1}, 2, steps_of(h), truth);
    const Errors fine = errors_of(system, {1}, 2, steps_of(h / 2), truth);
    last_order = std::log2(coarse.at_ends / fine.at_ends);
    EXPECT_GT(last_order, 4.5) << h;
    EXPECT_GT(std::log2(coarse.between / fine.between), 4) << h;
  }
  EXPECT_LT(last_order, 5.7);
}

// On a slow solution that all others run to at 10⁶/s, x = cos t is at the ends of steps right to 10⁻⁹ even
// where they are long; the polynomial between is of order 4.
TEST(RosenbrockSolver, KeepsItsOrderWhereTheEquationsAreStiff) {
  Equations system = prothero_robinson(1e6);
  const auto truth = [](double t) { return std::cos(t); };
  for (const double h : {0.4, 0.2}) {
    const Errors coarse = errors_of(system, {1}, 4, steps_of(h), truth);
    const Errors fine = errors_of(system, {1}, 4, steps_of(h / 2), truth);
    EXPECT_LT(coarse.at_ends, 1e-9) << h;
    EXPECT_GT(std::log2(coarse.between / fine.between), 3.8) << h;
  }
}

// The tolerance holds at the ends of steps and between, at any stiffness: of one step, and of the sum of
// those that the decay has not taken back, some ten at λ = 1.
TEST(RosenbrockSolver, HoldsItsToleranceBetweenTheEndsOfStepsToo) {
  for (const double rate : {0.0, 1.0, 10.0, 100.0, 1e3, 1e4, 1e6, 1e9}) {
    Equations system = prothero_robinson(rate);
    for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
      const Errors errors =
          errors_of(system, {1}, 10, at_tolerance(tolerance), [](double t) { return std::cos(t); });
      EXPECT_LT(errors.at_ends, 10 * tolerance) << rate << ' ' << tolerance;
      EXPECT_LT(errors.between, 10 * tolerance) << rate << ' ' << tolerance;
      EXPECT_LT(errors.steps, 4 / std::pow(tolerance, 0.25) + 20) << rate << ' ' << tolerance;
    }
  }
}

// Of a Jacobian that is wrong the differences make one that is right.
TEST(RosenbrockSolver, TakesDifferencesWhereTheJacobianIsNotExact) {
  Equations system = bell();
  system.by_states = [](double, const double*, double* j) { j[0] = 1e3; };
  system.exact = false;
  const Errors coarse = errors_of(system, {1}, 2, steps_of(0.05), [](double t) { return 1 / (1 + t * t); });
  const Errors fine = errors_of(system, {1}, 2, steps_of(0.025), [](double t) { return 1 / (1 + t * t); });
  EXPECT_GT(std::log2(coarse.at_ends / fine.at_ends), 4.5);
}

// x′ = −1/(2 x), x = √(1 − t), has no value from t = 1 on: the solver comes near, and says what is wrong.
TEST(RosenbrockSolver, ComesNearToWhereThereIsNoValue) {
  Equations system(
      1,
      [](double, const double* x, double* dxdt) {
        if (!(x[0] > 0)) return false;
        dxdt[0] = -1 / (2 * x[0]);
        return true;
      },
      [](double, const double* x, double* j) { j[0] = 1 / (2 * x[0] * x[0]); });
  const std::vector<double> one{1};
  RosenbrockSolver solver(system, 0, one, 2, 2, at_tolerance(1e-8));
  double t = 0;
  try {
    while (true) t = solver.step();
  } catch (const SolverFailure& failure) {
    EXPECT_EQ(failure.kind, SolverFailure::Kind::no_value);
    EXPECT_EQ(failure.time, t);
  }
  EXPECT_NEAR(t, 1, 1e-6);  // the error of x, 1e-8, moves the end of it by as much
}

// x′ = x², x = 1/(1 − t).
TEST(RosenbrockSolver, StopsWhereTheSolutionDoes) {
  Equations system(
      1,
      [](double, const double* x, double* dxdt) {
        dxdt[0] = x[0] * x[0];
        return true;
      },
      [](double, const double* x, double* j) { j[0] = 2 * x[0]; });
  const std::vector<double> one{1};
  RosenbrockSolver solver(system, 0, one, 2, 2, at_tolerance(1e-8));
  double t = 0;
  EXPECT_THROW(
      {
        while (true) t = solver.step();
      },
      SolverFailure);
  EXPECT_NEAR(t, 1, 1e-6);
}

TEST(RosenbrockSolver, EndsWhereItIsToldTo) {
  Equations system = bell();
  const std::vector<double> one{1};
  SolverSettings settings = at_tolerance(1e-6);
  settings.max_steps = 3;
  RosenbrockSolver solver(system, 0, one, 2, 2, settings);
  for (int k = 0; k < 3; ++k) solver.step();
  try {
    solver.step();
    FAIL();
  } catch (const SolverFailure& failure) {
    EXPECT_EQ(failure.kind, SolverFailure::Kind::step_budget);
  }
  RosenbrockSolver interrupted(system, 0, one, 2, 2, at_tolerance(1e-6));
  interrupted.step();
  system.ends = true;
  try {
    interrupted.step();
    FAIL();
  } catch (const SolverFailure& failure) {
    EXPECT_EQ(failure.kind, SolverFailure::Kind::interrupted);
  }
}

// A segment far shorter than what the time resolves keeps its length, and the end is the end to the bit.
TEST(RosenbrockSolver, KeepsSegmentsThatTheTimeDoesNotResolve) {
  Equations system(
      1,
      [](double, const double*, double* dxdt) {
        dxdt[0] = 1e20;
        return true;
      },
      [](double, const double*, double* j) { j[0] = 0; });
  const std::vector<double> zero{0};
  RosenbrockSolver solver(system, 1e6, zero, 1e6, 1e-19, at_tolerance(1e-8));
  double t = 0;
  int steps = 0;
  do {
    t = solver.step();
  } while (++steps < 100 && solver.states()[0] < 9.99);
  EXPECT_EQ(t, 1e6);
  EXPECT_NEAR(solver.states()[0], 10, 1e-12);
  solver.restart(2, zero, 3, 1);
  EXPECT_EQ(solver.states()[0], 0);
  while (t != 3) t = solver.step();
  EXPECT_NEAR(solver.states()[0] / 1e20, 1, 1e-12);
  // One of which the time shows the end, a rounding later, but not the middle.
  const double next = std::nextafter(1.0, 2.0), length = 0.7 * (next - 1);
  solver.restart(1, zero, next, length);
  for (int k = 0; k < 100 && t != next; ++k) t = solver.step();
  EXPECT_NEAR(solver.states()[0] / (1e20 * length), 1, 1e-12);
}

// Of what was before nothing is left, to the bit; the work goes on being counted.
TEST(RosenbrockSolver, StartsAnew) {
  Equations system = bell();
  const std::vector<double> one{1}, four{4};
  RosenbrockSolver solver(system, 0, four, 2, 2, at_tolerance(1e-8)),
      other(system, 0.5, one, 2, 1.5, at_tolerance(1e-8));
  for (int k = 0; k < 10; ++k) solver.step();
  const SolverStatistics before = solver.statistics();
  solver.restart(0.5, one, 2, 1.5);
  std::vector<double> x(1);
  solver.states_at(0.5, x);
  EXPECT_EQ(x, one);
  for (double t = 0.5; t < 2;) {
    t = solver.step();
    EXPECT_EQ(t, other.step());
    EXPECT_EQ(solver.states()[0], other.states()[0]);
    solver.states_at(t - 1e-4, x);
    const double read = x[0];
    other.states_at(t - 1e-4, x);
    EXPECT_EQ(read, x[0]);
  }
  EXPECT_EQ(solver.statistics().steps, before.steps + other.statistics().steps);
  EXPECT_EQ(solver.statistics().evaluations, before.evaluations + other.statistics().evaluations);
}

// d/dt of the polynomial, against differences of it: (1e-6 of a step)² and rounding over that.
TEST(RosenbrockSolver, GivesTheRatesOfItsPolynomial) {
  Equations system = prothero_robinson(10);
  const std::vector<double> start{0.5};
  RosenbrockSolver solver(system, 0, start, 10, 10, at_tolerance(1e-8));
  std::vector<double> low(1), high(1), rate(1);
  double from = 0;
  for (int k = 0; k < 12; ++k) {
    const double t = solver.step(), h = t - from;
    for (const double part : {0.1, 0.5, 0.9}) {
      const double at = from + part * h, apart = 1e-4 * h;
      solver.states_at(at - apart, low);
      solver.states_at(at + apart, high);
      solver.rates_at(at, rate);
      EXPECT_NEAR(rate[0], (high[0] - low[0]) / (2 * apart), 1e-7 + 1e-11 / apart) << at;
    }
    from = t;
  }
}

}  // namespace
}  // namespace oblique::solve
