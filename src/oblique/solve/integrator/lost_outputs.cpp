// SPDX-License-Identifier: MIT
#include <oblique/solve/integrator/lost_outputs.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include <oblique/solve/readings/error_signs.h>

namespace oblique::solve {
namespace {

/// Of what the tolerances leave to a state in a step: what the steps together do.
constexpr double kErrors = 10;

/// An output that the errors move by this part of its largest magnitude has no digit left.
constexpr double kNoDigit = 0.3;
/// Of the relative tolerance, in machine units: outputs that are smaller mean zero.
constexpr double kLeast = 1e4;
/// Of the relative tolerance, of its largest magnitude: what a state that has decayed to its errors may move
/// an output by (the logarithm of a decay).
constexpr double kMuchByDecayed = 1e4;

}  // namespace

LostOutputs::LostOutputs(const diagram::FlatDiagram& diagram, OdeSystem& system,
                         const SolverSettings& settings, double span, Outputs outputs)
    : diagram_(diagram),
      system_(system),
      settings_(settings),
      span_(span),
      outputs_(std::move(outputs)),
      sizes_(diagram.outputs.size(), 0),
      losses_(diagram.outputs.size()),
      values_(diagram.outputs.size()),
      moved_(diagram.outputs.size()) {}

double LostOutputs::error_of_state(std::size_t i, double x) const {
  return kErrors * (settings_.relative_tolerance * std::abs(x) + settings_.absolute_tolerance_of(i));
}

/// Whether what the states were moved by has taken the last digit of an output.
bool LostOutputs::is_lost(std::size_t output) const {
  return is_moved_by(output, kNoDigit);
}

/// Whether it has moved an output by this part of its largest magnitude.
bool LostOutputs::is_moved_by(std::size_t output, double part) const {
  return std::abs(moved_[output] - values_[output]) >
         std::max(part * sizes_[output], kLeast * settings_.relative_tolerance);
}

void LostOutputs::advance(double t, std::span<const double> x) {
  if (steps_++ < next_look_) return;
  next_look_ = 2 * next_look_ + 1;
  look(t, x);
}

void LostOutputs::begin_segment(double t, std::span<const double> x) {
  constexpr unsigned long kAll = 64;
  if (++segments_ <= kAll || std::has_single_bit(segments_)) look(t, x);
}

void LostOutputs::look(double t, std::span<const double> x) {
  bool any_moved = false;
  if (!outputs_(t, x.data(), values_.data())) return;
  for (std::size_t k = 0; k < values_.size(); ++k) sizes_[k] = std::max(sizes_[k], std::abs(values_[k]));
  off_states_.resize(x.size());
  for (std::uint64_t trial = 0; trial < ErrorSigns::kTrials; ++trial) {
    ErrorSigns signs(trial);
    for (std::size_t i = 0; i < x.size(); ++i) off_states_[i] = x[i] + signs.next() * error_of_state(i, x[i]);
    if (!outputs_(t, off_states_.data(), moved_.data())) continue;
    for (std::size_t k = 0; k < values_.size(); ++k) {
      any_moved = any_moved || is_moved_by(k, kMuchByDecayed * settings_.relative_tolerance);
      if (losses_[k].time < 0 && is_lost(k)) losses_[k] = {t, values_[k], std::abs(moved_[k] - values_[k])};
    }
  }
  if (any_moved) find_decayed(t, x);
  outputs_(t, x.data(), values_.data());  // leaves the solutions of algebraic loops where they were
}

/// Looks which states are so small that their absolute tolerance decides what they are known to, hardly move,
/// and move an output by much by themselves. One that crosses zero moves, and is known as it was.
void LostOutputs::find_decayed(double t, std::span<const double> x) {
  constexpr double kSoon = 1e-3;  // of the run
  std::vector<double> rates(x.size());
  if (!system_.derivatives(t, x.data(), rates.data())) return;
  off_states_.assign(x.begin(), x.end());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double error = error_of_state(i, x[i]), size = std::abs(x[i]);
    if (size == 0 || settings_.relative_tolerance * size > settings_.absolute_tolerance_of(i) ||
        std::abs(rates[i]) * kSoon * span_ > std::max(size, error))
      continue;
    for (const double off : {error, -error}) {
      off_states_[i] = x[i] + off;
      if (!outputs_(t, off_states_.data(), moved_.data())) continue;
      for (std::size_t k = 0; k < values_.size(); ++k) {
        if (is_moved_by(k, kMuchByDecayed * settings_.relative_tolerance)) decayed_.insert(i);
      }
    }
    off_states_[i] = x[i];
  }
}

std::vector<text::Diagnostic> LostOutputs::warnings(const std::vector<bool>& told) const {
  std::vector<text::Diagnostic> warnings;
  for (std::size_t k = 0; k < losses_.size(); ++k) {
    const Loss& loss = losses_[k];
    if (loss.time < 0 || told[k]) continue;
    warnings.push_back(
        {{diagram_.file, {}},
         fmt::format("no digit of the output '{}' is known: at t = {:.6g} s it reads {:.3g}, and the errors "
                     "that the tolerance leaves to the states move it by {:.3g}",
                     diagram_.outputs[k].name, loss.time, loss.value, loss.moved),
         {},
         "look for a division by what comes to zero, or a difference of what is nearly alike; where it is "
         "meant, a finer 'tolerance' in [run] carries further"});
  }
  return warnings;
}

}  // namespace oblique::solve
