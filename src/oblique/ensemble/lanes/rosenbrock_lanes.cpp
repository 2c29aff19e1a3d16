// SPDX-License-Identifier: MIT
#include <oblique/ensemble/lanes/rosenbrock_lanes.h>

#include <algorithm>

#include <oblique/solve/integrator/rosenbrock.h>

namespace oblique::ensemble {

using solve::Rodas5p;

namespace {

constexpr double kOne = 1, kMinusOne = -1;  // factors of a kernel

}  // namespace

RosenbrockLanes::RosenbrockLanes(const LaneProgram& program, const LaneKernels& kernels,
                                 const LaneStates& lanes)
    : program_(program),
      kernels_(kernels),
      width_(static_cast<std::size_t>(kernels.width)),
      n_(static_cast<std::uint32_t>(program.n_variables)),
      size_(program.n_variables * static_cast<std::size_t>(kernels.width)),
      stages_(Rodas5p::kStages * size_),
      entries_(program.lu.n_entries() * width_) {
  for (LaneArray* const variables : {&right_side_, &work_, &by_time_, &reciprocals_, &bends_[0], &bends_[1],
                                     &bends_[2], &slope_, &change_})
    *variables = LaneArray(size_);
  for (LaneArray* const numbers : {&scale_, &inverse_, &time_scale_}) *numbers = LaneArray(width_);
  for (std::size_t i = 0; i < Rodas5p::kStages; ++i) stage_.push_back(stages_.data() + i * size_);
  for (const std::uint32_t slot : program.rate_slots) rate_.push_back(lanes.slots.data() + slot * width_);
}

void RosenbrockLanes::step(LaneStates& lanes) {
  double* const slots = lanes.slots.data();
  double* const variables = slots + width_;
  const auto n_states = static_cast<std::uint32_t>(program_.n_states);
  const StraightLuCode lu = program_.lu.code();
  bends_known_ = false;
  for (std::size_t l = 0; l < width_; ++l) {
    inverse_[l] = 1 / lanes.h[l];
    scale_[l] = 1 / (lanes.h[l] * Rodas5p::kGamma);
  }
  for (std::uint32_t i = 0; i < Rodas5p::kStages; ++i) {
    for (std::size_t l = 0; l < width_; ++l) slots[l] = lanes.t[l] + Rodas5p::c[i] * lanes.h[l];
    kernels_.combine(n_, i, Rodas5p::a[i], stage_.data(), lanes.u.data(), variables);
    kernels_.run(program_.rates.code(), slots);
    if (i == 0) {
      kernels_.run(program_.derivatives.code(), slots);
      kernels_.matrix(program_.matrix(), slots, scale_.data(), entries_.data());
      kernels_.factor(lu, entries_.data(), reciprocals_.data(), lanes.growth.data());
      for (const LaneConstant& entry : program_.by_time)
        std::copy_n(slots + entry.slot * width_, width_, by_time_.data() + entry.drawn * width_);
    }
    const bool by_time = !program_.by_time.empty() && Rodas5p::d[i] != 0;
    if (by_time) {
      for (std::size_t l = 0; l < width_; ++l) time_scale_[l] = lanes.h[l] * Rodas5p::d[i];
    }
    kernels_.right_side(n_, n_states, i, Rodas5p::C[i], stage_.data(), inverse_.data(),
                        by_time ? by_time_.data() : nullptr, time_scale_.data(), rate_.data(),
                        right_side_.data());
    kernels_.solve(lu, entries_.data(), reciprocals_.data(), right_side_.data(), work_.data(),
                   stages_.data() + i * size_);
  }
  kernels_.combine(n_, 1, &kOne, stage_.data() + Rodas5p::kStages - 1, variables, lanes.after.data());
  kernels_.norm(n_, stage_.back(), lanes.u.data(), lanes.after.data(), program_.absolute.data(),
                program_.relative, lanes.error.data());
}

void RosenbrockLanes::find_between(LaneStates& lanes) {
  if (!bends_known_) {
    for (std::size_t k = 0; k < 3; ++k)
      kernels_.combine(n_, Rodas5p::kStages, Rodas5p::between[k], stage_.data(), nullptr, bends_[k].data());
  }
  bends_known_ = true;
  kernels_.between(n_, lanes.theta.data(), lanes.u.data(), lanes.after.data(), bends_[0].data(),
                   bends_[1].data(), bends_[2].data(), lanes.between.data(), slope_.data());
  correct_between(lanes);
}

/// The polynomial is of order 4 where nothing is stiff. What follows others fast it misses by a hundred times
/// more: there F at the polynomial tells by how much, and W, which is still that of the step, takes it away.
void RosenbrockLanes::correct_between(LaneStates& lanes) {
  double* const slots = lanes.slots.data();
  std::copy_n(lanes.between.data(), size_, slots + width_);
  for (std::size_t l = 0; l < width_; ++l) slots[l] = lanes.t[l] + lanes.theta[l] * lanes.h[l];
  kernels_.run(program_.rates.code(), slots);
  const double* const slope = slope_.data();
  kernels_.right_side(n_, static_cast<std::uint32_t>(program_.n_states), 1, &kMinusOne, &slope,
                      inverse_.data(), nullptr, nullptr, rate_.data(), right_side_.data());
  kernels_.solve(program_.lu.code(), entries_.data(), reciprocals_.data(), right_side_.data(), work_.data(),
                 change_.data());
  const double* const change = change_.data();
  kernels_.combine(n_, 1, &kOne, &change, lanes.between.data(), lanes.between.data());
}

double RosenbrockLanes::step_factor(double error) const {
  constexpr double kRoot[] = {0.92211035, -0.12278577, 0.04900795, -0.02653251, 0.01457163};
  constexpr double kPowers[] = {1, 0.8705505632961241, 0.757858283255199, 0.6597539553864471,
                                0.5743491774985175};
  return step_factor_of(error, 5, kRoot, kPowers);
}

}  // namespace oblique::ensemble
