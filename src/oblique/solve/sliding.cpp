// SPDX-License-Identifier: MIT
// The part of Switching that knows where a surface goes, and slides along one to which both sides push.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <oblique/solve/solve_error.h>
#include <oblique/solve/switching.h>

namespace oblique {
namespace {

/// How far the states are moved to see where a surface drifts [machine unit]: its square is above rounding,
/// its cube below.
constexpr double kProbe = 1e-6;

}  // namespace

/// d surface/dt along the solution with the switch held in one position, by a central difference that moves
/// the states by kProbe; a surface at its turning point shows where it bends.
double Switching::drift(std::size_t s, double position, double t, std::span<const double> x) {
  if (is_known(s)) return program_.known_rate(s, workspace_).value_or(0);
  const std::uint32_t memory = program_.switches()[s].memory;
  const double before = workspace_.memory(memory);
  workspace_.set_memory(memory, position);
  double result = 0;
  if (program_.derivatives(t, x.data(), slopes_.data(), workspace_)) {
    double fastest = 0;
    for (const double slope : slopes_) fastest = std::max(fastest, std::abs(slope));
    const double dt =
        std::min(kProbe / std::max(fastest, std::numeric_limits<double>::min()), kProbe * span_);
    // The way there bends with the slope half way.
    const auto surface_after = [&](double step) {
      for (std::size_t i = 0; i < x.size(); ++i) moved_[i] = x[i] + step / 2 * slopes_[i];
      if (!program_.derivatives(t + step / 2, moved_.data(), slopes_there_.data(), workspace_)) return 0.0;
      for (std::size_t i = 0; i < x.size(); ++i) moved_[i] = x[i] + step * slopes_there_[i];
      if (!program_.surfaces(t + step, moved_.data(), surfaces_.data(), workspace_)) return 0.0;
      return surfaces_[s];
    };
    const double ahead = surface_after(dt);
    const double behind = surface_after(-dt);
    constexpr double kNothing = 1e-14;  // rounding of the two surfaces
    result = std::abs(ahead - behind) < kNothing ? 0 : (ahead - behind) / (2 * dt);
    const bool turns_here = std::abs(ahead - behind) < kProbe * (std::abs(ahead) + std::abs(behind));
    if (turns_here) result = std::abs(ahead) < kNothing ? 0 : ahead / dt;
  }
  workspace_.set_memory(memory, before);
  program_.surfaces(t, x.data(), surfaces_.data(), workspace_);
  return result;
}

/// A switch whose surface is zero goes where it drifts. True where it turned over or slides now.
bool Switching::decide_on_surface(std::size_t s, double t, std::span<const double> x) {
  const double before = workspace_.memory(program_.switches()[s].memory);
  const double from_below = drift(s, 0, t, x);
  const double from_above = drift(s, 1, t, x);
  double position = before;
  if (from_below > 0 && from_above < 0 && !is_known(s)) {
    if (sliding_ && *sliding_ != s) {
      throw SolveError(
          SolveError::Kind::chatter, t,
          {{file_, {}},
           fmt::format("'{}' and '{}' slide along their switching surfaces at once at t = {:.9g} s",
                       program_.switches()[*sliding_].block, program_.switches()[s].block, t),
           "one sliding switch at a time",
           "give one of them a hysteresis"});
    }
    if (!sliding_)
      record(t, fmt::format("{}: slides along {} = 0", program_.switches()[s].block,
                            program_.switches()[s].comparison));
    sliding_ = s;
    workspace_.set_memory(program_.switches()[s].memory, sliding_position(t, x));
    return true;
  }
  if (from_below > 0 && from_above >= 0) position = 1;
  if (from_below <= 0 && from_above < 0) position = 0;
  turn(s, position, t);
  return position != before;
}

/// The position between 0 and 1 with which the surface stays where it is: outside them the slide is over.
double Switching::sliding_position(double t, std::span<const double> x) {
  const double from_below = drift(*sliding_, 0, t, x);
  const double from_above = drift(*sliding_, 1, t, x);
  const double difference = from_below - from_above;
  if (difference == 0) return -1;
  return from_below / difference;
}

/// Ends a slide on the side to which the surface now drifts.
void Switching::leave_sliding(double t, std::span<const double> x) {
  const std::size_t s = *sliding_;
  const double position = sliding_position(t, x);
  sliding_.reset();
  const double side = position >= 0.5 ? 1 : 0;
  workspace_.set_memory(program_.switches()[s].memory, side);
  record(t,
         fmt::format("{}: leaves {} = 0", program_.switches()[s].block, program_.switches()[s].comparison));
}

void Switching::place_sliding(double t, std::span<const double> x) {
  if (!sliding_) return;
  const double position = std::clamp(sliding_position(t, x), 0.0, 1.0);
  workspace_.set_memory(program_.switches()[*sliding_].memory, position);
}

bool Switching::derivatives(double t, const double* x, double* dxdt) {
  place_sliding(t, {x, program_.n_states()});
  return program_.derivatives(t, x, dxdt, workspace_);
}

bool Switching::jacobian(double t, const double* x, double* values) {
  return program_.jacobian(t, x, values, workspace_);
}

}  // namespace oblique
