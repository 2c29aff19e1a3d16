// SPDX-License-Identifier: MIT
#include <oblique/solve/integrator/method.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include <fmt/format.h>

#include <oblique/network/program/program.h>
#include <oblique/solve/operating_point/rest.h>
#include <oblique/solve/stability/coupled_modes.h>

namespace oblique::solve {
namespace {

/// A decay is left to BDF from this ratio of its rate to that of what moves beside it.
constexpr double kStiff = 100;

/// Time constants of the fastest decay in a run: below the first Adams' formulas pass it in a few hundred
/// steps, as stiff as it may be; from the second it is left to BDF even where nothing else has a rate, for
/// Adams takes a step or more for each.
constexpr double kShortRun = 300, kLongRun = 1e4;

/// What would move by less than this part of itself in the whole run does not move: an integrator, whose
/// eigenvalue is zero, is no slow decay.
constexpr double kStill = 1e-2;

/// Of the magnitude of an eigenvalue: a mode of more damping is over after two turns, and a decay.
constexpr double kDamped = 0.3;

/// The rates of the equations linearised [1/s]; 0 where there is none of the kind.
struct Rates {
  double fastest_decay = 0, slowest_decay = 0;
  double lasting = 0;       ///< the fastest of what oscillates or grows
  bool oscillates = false;  ///< that one
};

void count(std::complex<double> mode, double span, Rates& rates) {
  const double rate = std::abs(mode);
  if (rate * span < kStill) return;
  if (mode.real() < -kDamped * rate) {
    rates.fastest_decay = std::max(rates.fastest_decay, rate);
    rates.slowest_decay = rates.slowest_decay == 0 ? rate : std::min(rates.slowest_decay, rate);
  } else if (rate > rates.lasting) {
    rates.lasting = rate;
    rates.oscillates = std::abs(mode.imag()) > std::abs(mode.real());
  }
}

MethodChoice from_rates(const Rates& rates, double span, const std::string& when) {
  using Method = diagram::IntegrationMethod;
  const double constants = rates.fastest_decay * span;
  // What oscillates or grows asks for short steps all the time; slow decays do so only where nothing else
  // moves.
  if (rates.lasting > 0 && rates.fastest_decay > kStiff * rates.lasting && constants > kShortRun) {
    return {Method::bdf, fmt::format("a decay of {:.3g} 1/s {}, beside what moves at {:.3g} 1/s",
                                     rates.fastest_decay, when, rates.lasting)};
  }
  if (rates.lasting == 0 && rates.fastest_decay > kStiff * rates.slowest_decay && constants > kShortRun) {
    return {Method::bdf, fmt::format("decays from {:.3g} to {:.3g} 1/s {}", rates.slowest_decay,
                                     rates.fastest_decay, when)};
  }
  if (rates.lasting == 0 && constants > kLongRun) {
    return {Method::bdf,
            fmt::format("a decay of {:.3g} 1/s {} of a run of {:.3g} s", rates.fastest_decay, when, span)};
  }
  if (rates.oscillates && rates.lasting > rates.fastest_decay) {
    return {Method::adams,
            fmt::format("the fastest mode {} oscillates, at {:.3g} rad/s", when, rates.lasting)};
  }
  return {Method::adams, "nothing is fast " + when};
}

MethodChoice from_linearisation(const network::Program& program, network::Workspace& workspace, double t,
                                std::span<const double> states, double span, const std::string& when) {
  const network::SparsePattern& pattern = program.jacobian_pattern();
  std::vector<double> values(pattern.entries());
  const auto unknown = [](std::string why) {
    return MethodChoice{diagram::IntegrationMethod::bdf, std::move(why)};
  };
  if (!program.jacobian(t, states.data(), values.data(), workspace))
    return unknown("the equations have no linearisation " + when);
  Rates rates;
  for (const CoupledModes& group : coupled_modes(pattern, values, std::vector<bool>(pattern.size(), true))) {
    if (group.eigenvalues.empty() && group.states.size() > 1) {
      return unknown(fmt::format("{} states that act on each other, too many to look for fast ones",
                                 group.states.size()));
    }
    if (group.eigenvalues.empty()) return unknown("the equations have no linearisation " + when);
    for (const std::complex<double>& mode : group.eigenvalues) count(mode, span, rates);
  }
  return from_rates(rates, span, when);
}

}  // namespace

MethodChoice choose_method(diagram::IntegrationMethod asked, const network::Program& program,
                           network::Workspace& workspace, double t, std::span<const double> states,
                           double span) {
  if (asked != diagram::IntegrationMethod::automatic) return {asked, "as the diagram asks"};
  const std::size_t servos = rest_states(program).size();
  if (servos > 0) {
    return {
        diagram::IntegrationMethod::bdf,
        fmt::format("{} {} faster than what {} {}", servos, servos == 1 ? "servo loop is" : "servo loops are",
                    servos == 1 ? "it" : "they", servos == 1 ? "follows" : "follow")};
  }
  return from_linearisation(program, workspace, t, states, span, "at the start");
}

std::optional<MethodChoice> stiff_method(const network::Program& program, network::Workspace& workspace,
                                         double t, std::span<const double> states, double span) {
  const MethodChoice choice =
      from_linearisation(program, workspace, t, states, span, fmt::format("at t = {:.6g} s", t));
  if (choice.method != diagram::IntegrationMethod::bdf) return std::nullopt;
  return choice;
}

}  // namespace oblique::solve
