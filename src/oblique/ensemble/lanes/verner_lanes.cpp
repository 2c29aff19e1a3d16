// SPDX-License-Identifier: MIT
#include <oblique/ensemble/lanes/verner_lanes.h>

#include <algorithm>

#include <oblique/ensemble/lanes/verner.h>

namespace oblique::ensemble {

VernerLanes::VernerLanes(const LaneProgram& program, const LaneKernels& kernels, const LaneStates& /*lanes*/)
    : program_(program),
      kernels_(kernels),
      width_(static_cast<std::size_t>(kernels.width)),
      n_(static_cast<std::uint32_t>(program.n_variables)),
      size_(program.n_variables * static_cast<std::size_t>(kernels.width)),
      stages_(Verner7::kAllStages * size_),
      error_(size_),
      weights_(Verner7::kAllStages * width_) {
  for (std::size_t i = 0; i < Verner7::kAllStages; ++i) stage_.push_back(stages_.data() + i * size_);
}

void VernerLanes::find_stage(LaneStates& lanes, std::size_t stage) {
  double* const slots = lanes.slots.data();
  for (std::size_t l = 0; l < width_; ++l) slots[l] = lanes.t[l] + Verner7::c[stage] * lanes.h[l];
  kernels_.advance(n_, static_cast<std::uint32_t>(stage), Verner7::a[stage], stage_.data(), lanes.h.data(),
                   lanes.u.data(), slots + width_);
  kernels_.run(program_.rates.code(), slots);
  double* to = stages_.data() + stage * size_;
  for (const std::uint32_t slot : program_.rate_slots) to = std::copy_n(slots + slot * width_, width_, to);
}

void VernerLanes::step(LaneStates& lanes) {
  all_known_ = false;
  for (std::size_t i = 0; i < Verner7::kStages; ++i) find_stage(lanes, i);
  kernels_.advance(n_, Verner7::kStages, Verner7::b, stage_.data(), lanes.h.data(), lanes.u.data(),
                   lanes.after.data());
  kernels_.advance(n_, Verner7::kStages, Verner7::error, stage_.data(), lanes.h.data(), nullptr,
                   error_.data());
  kernels_.norm(n_, error_.data(), lanes.u.data(), lanes.after.data(), program_.absolute.data(),
                program_.relative, lanes.error.data());
}

void VernerLanes::find_between(LaneStates& lanes) {
  for (std::size_t i = Verner7::kStages; !all_known_ && i < Verner7::kAllStages; ++i) find_stage(lanes, i);
  all_known_ = true;
  for (std::size_t i = 0; i < Verner7::kAllStages; ++i) {
    for (std::size_t l = 0; l < width_; ++l) {
      double weight = 0;
      for (std::size_t power = Verner7::kPowers; power-- > 0;)
        weight = lanes.theta[l] * (Verner7::between[i][power] + weight);
      weights_[i * width_ + l] = lanes.h[l] * weight;
    }
  }
  kernels_.weigh(n_, Verner7::kAllStages, weights_.data(), stage_.data(), lanes.u.data(),
                 lanes.between.data());
}

double VernerLanes::step_factor(double error) const {
  constexpr double kRoot[] = {0.943723115, -0.089799773, 0.034152001, -0.017729683, 0.009554881};
  constexpr double kPowers[] = {1,
                                0.9057236642639067,
                                0.820335356007638,
                                0.7429971445684742,
                                0.6729500963161781,
                                0.6095068271022377,
                                0.5520447568369062};
  return step_factor_of(error, 7, kRoot, kPowers);
}

}  // namespace oblique::ensemble
