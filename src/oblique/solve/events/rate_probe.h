// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <oblique/network/program/program.h>

namespace oblique::solve {

/// The rate of an event function at a point.
struct ProbedRate {
  double rate = 0;
  double later = 0;  ///< a moment on
  double step = 0;   ///< that moment [s]
  double noise = 0;  ///< what rounding of the states makes of the rate
};

/// Where event functions go from a point with the switches as they stand, seen by a step that is so short
/// that what is fast goes straight on. Not installed.
class RateProbe {
 public:
  /// All must outlive this; `span` is the length of the run [s].
  RateProbe(const network::Program& program, network::Workspace& workspace, double span);

  /// Takes the rates where `here` was evaluated, beside a state as fast as `least`.
  void begin(const network::Evaluation& here, double least);
  double rate(std::size_t s) const { return rates_[s]; }
  /// The rate of the fastest state, at least `least`.
  double fastest() const { return fastest_; }

  /// Then looks a moment on from there, (t, x); where the rounding of the states shows in the rates of
  /// `switches`, by a shorter step. False where nothing has a value there.
  bool look(std::span<const std::uint32_t> switches, double t, std::span<const double> x);
  /// What has been found.
  ProbedRate operator[](std::size_t s) const { return {rates_[s], later_[s], step_, noise_[s]}; }

  /// Finds what the rounding of the states makes of the rates from which it has begun at (t, x): much, where
  /// something fast is nearly in balance.
  void find_noise(double t, std::span<const double> x);
  double noise(std::size_t s) const { return noise_[s]; }
  /// For how long what shows so goes straight on [s].
  double straight(std::size_t s) const;

 private:
  const network::Program& program_;
  network::Workspace& workspace_;
  double span_;
  double step_ = 0, fastest_ = 0;
  std::vector<double> rates_, later_, noise_, derivatives_;
  std::vector<double> moved_, moved_derivatives_, event_functions_;
};

/// Beside what a rate of an event function is one.
struct RateScale {
  double rate = 0;     ///< the largest here
  double later = 0;    ///< the largest a moment on
  double fastest = 0;  ///< of all dx/dt
  double span = 0;     ///< the length of the run [s]
};

/// Whether its rate alone tells to which side an event function goes: it is none of rounding, and does not
/// turn at once.
bool is_decisive(const ProbedRate& probed, const RateScale& beside);

/// To which side an event function goes that is zero: 1, −1, or 0 where it stays there.
int side_of(const ProbedRate& probed, const RateScale& beside);

}  // namespace oblique::solve
