// SPDX-License-Identifier: MIT
#include <oblique/network/program/program.h>
#include <oblique/solve/integrator/solver.h>
#include <oblique/solve/run_errors.h>

#include <algorithm>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace oblique::solve {
namespace {

constexpr std::size_t kMostNamed = 5;

/// "a → b → c → a", shortened in the middle where the loop is long.
std::string loop_path(const network::Loop& loop) {
  std::vector<std::string> names = loop.members;
  if (names.size() > 2 * kMostNamed) {
    names.erase(names.begin() + kMostNamed, names.end() - kMostNamed);
    names.insert(names.begin() + kMostNamed, "…");
  }
  names.push_back(loop.members.front());
  return fmt::format("{}", fmt::join(names, " → "));
}

std::string worst_blocks(const network::Program& program, const Solver& solver) {
  const std::vector<double> errors = solver.weighted_errors();
  const auto states = solver.states();
  std::vector<std::size_t> order(errors.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return errors[a] > errors[b]; });
  if (order.size() > kMostNamed) order.resize(kMostNamed);
  std::string text = "\n  largest weighted local errors:";
  for (const std::size_t i : order) {
    text += fmt::format("\n    {} = {:.6g}  (error {:.2g} of its tolerance)", program.states()[i].name,
                        states[i], errors[i]);
  }
  return text;
}

std::size_t largest_state(const Solver& solver) {
  const auto states = solver.states();
  const auto largest = std::max_element(states.begin(), states.end(),
                                        [](double a, double b) { return std::abs(a) < std::abs(b); });
  return static_cast<std::size_t>(largest - states.begin());
}

}  // namespace

SolveError loop_error(const network::Program& program, const network::Workspace::Trouble& trouble, double t,
                      const std::string& file) {
  if (trouble.failure == network::LoopFailure::none) {  // what fails is no loop but a slide
    return {SolveError::Kind::chatter,
            t,
            {{file, {}},
             fmt::format("at t = {:.6g} s no mixture of both of its sides keeps a switch on the switching "
                         "surface that it "
                         "slides along",
                         t),
             {},
             "give the switch a hysteresis"}};
  }
  const network::Loop& loop = program.loops()[trouble.loop];
  const network::Unknown& unknown = program.unknowns()[loop.unknowns.front()];
  const std::string path = loop_path(loop);
  const text::Place place{unknown.place.file.empty() ? file : unknown.place.file, unknown.place.position};
  std::string what, remedy;
  if (trouble.failure == network::LoopFailure::singular && loop.unknowns.size() == 1 && unknown.torn) {
    what = fmt::format("the algebraic loop {} is singular at t = {:.6g} s: its gain is {:.6g}", path, t,
                       trouble.derivative + 1);
    remedy = "change a weight so that the gain of the loop is not 1, or put an integrator into it";
  } else if (trouble.failure == network::LoopFailure::singular && loop.unknowns.size() == 1) {
    what = fmt::format(
        "the algebraic loop {} is singular at t = {:.6g} s: its gain is {:.6g}, "
        "the inputs of '{}' do not respond to its output",
        path, t, trouble.derivative, unknown.name);
    remedy =
        "wire the output back so that the residual changes with it, start it at another 'initial', or give "
        "the "
        "amplifier a finite gain and bandwidth";
  } else if (trouble.failure == network::LoopFailure::singular) {
    what = fmt::format(
        "the algebraic loop {} is singular at t = {:.6g} s: its {} equations determine no unique "
        "solution (a combination of its gains is 1)",
        path, t, loop.unknowns.size());
    remedy = "change a weight, or put an integrator or a servo amplifier of finite bandwidth into the loop";
  } else if (trouble.failure == network::LoopFailure::lost) {
    const bool is_held = program.loop_has_branches(trouble.loop);
    what = fmt::format(
        "the algebraic loop {} loses its solution at t = {:.6g} s: the branch that it was on ends near {} = "
        "{:.6g}, and {}",
        path, t, unknown.name, trouble.value,
        is_held ? "its amplifiers find no other operating point" : "its elements lead to no other");
    remedy = fmt::format(
        "check that its equation can be satisfied (a root of a negative number, a triangle that cannot "
        "close?), or {}, to see where it goes",
        is_held ? "give its amplifier a finite gain and bandwidth, or a 'limit'"
                : "put a lag, or a servo amplifier, into it");
  } else {
    what = fmt::format("the algebraic loop {} has no solution near {} = {:.6g} at t = {:.6g} s", path,
                       unknown.name, trouble.value, t);
    remedy =
        "check that its equation can be satisfied (a root of a negative number, a triangle that cannot "
        "close?), "
        "or start it from another 'initial'";
  }
  return {SolveError::Kind::singular_loop, t, {place, what, {}, remedy}};
}

SolveError run_error(const network::Program& program, const SolverFailure& failure, const Solver& solver,
                     const network::Workspace& workspace, const std::string& file) {
  using Kind = SolverFailure::Kind;
  if (failure.kind == Kind::no_value && workspace.trouble().failure != network::LoopFailure::none) {
    return loop_error(program, workspace.trouble(), failure.time, file);
  }
  const std::size_t largest = largest_state(solver);
  const std::string where = fmt::format("the run stopped at t = {:.6g} s", failure.time);
  const std::string value =
      fmt::format("'{}' = {:.4g}", program.states()[largest].name, solver.states()[largest]);
  const std::string details = worst_blocks(program, solver);
  switch (failure.kind) {
    case Kind::not_finite:
    case Kind::no_value:
    case Kind::small_step:
      return {
          SolveError::Kind::blow_up,
          failure.time,
          {{file, {}},
           fmt::format("{}: the solution grows without bound or jumps there, {}{}", where, value, details),
           {},
           {"look for a positive feedback, a divisor that passes zero or a servo loop whose residual falls "
            "with its output; or end the run earlier with ",
            text::Setting{"until"}}}};
    case Kind::no_derivative:
      return {SolveError::Kind::blow_up,
              failure.time,
              {{file, {}},
               fmt::format(
                   "{}: an equation has a value there, but no derivative by a parameter or by a state that "
                   "depends on one, so that the sensitivities have none (a power of zero, or the edge of a "
                   "branch)",
                   where),
               {},
               {"ask for no sensitivities, for those by other parameters, or end the run earlier with ",
                text::Setting{"until"}}}};
    case Kind::step_budget: {
      const double last_step = solver.statistics().last_step;
      constexpr double kStuck = 1e-10;  // of the time: no number of steps leads on
      const bool stuck = last_step < kStuck * std::abs(failure.time);
      return {SolveError::Kind::step_budget,
              failure.time,
              {{file, {}},
               fmt::format("{}: its budget of {} steps is used up, the last step was {:.2g} s{}", where,
                           solver.statistics().steps, last_step, details),
               {},
               stuck ? text::Remedy{"end the run earlier with ", text::Setting{"until"},
                                    fmt::format(", or look at what comes to an end near t = {:.6g} s: "
                                                "its steps become ever shorter there",
                                                failure.time)}
                     : text::Remedy{
                           "raise max_steps in [run], loosen the tolerance, or end the run earlier with ",
                           text::Setting{"until"}}}};
    }
    case Kind::interrupted:
    case Kind::other:
      break;
  }
  return {SolveError::Kind::other,
          failure.time,
          {{file, {}},
           fmt::format("{}: CVODES gave up with code {}{}", where, failure.code, details),
           {},
           "loosen the tolerance in [run]"}};
}

std::string shortened(std::vector<std::string> names) {
  if (names.size() > kMostNamed) {
    names.resize(kMostNamed);
    names.emplace_back("…");
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

SolveError rest_error(const network::Program& program, const std::vector<std::size_t>& worst,
                      const std::vector<double>& states, const std::vector<std::size_t>& loop,
                      const std::string& file) {
  std::string names;
  for (std::size_t i = 0; i < std::min(worst.size(), kMostNamed); ++i) {
    names += fmt::format("{}'{}' (at {:.4g})", i == 0 ? "" : ", ", program.states()[worst[i]].name,
                         states[worst[i]]);
  }
  return {
      SolveError::Kind::no_rest,
      0,
      {{file, {}},
       fmt::format("the servo loops do not come to rest before the clock starts{}; still moving: {}",
                   loop.size() > worst.size() ? ", nor when all states on their loop move" : "", names),
       "residuals that rise with the output of their amplifier",
       "check the signs at the amplifier's inputs, that its equation has a solution at the start, and its "
       "'initial'; or let the run begin unsettled, with settle = false in [run]"}};
}

}  // namespace oblique::solve
